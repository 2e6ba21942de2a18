"""Many jobs at once: here, in several processes, or on the machines of a cluster; what the jobs are is not known here."""
