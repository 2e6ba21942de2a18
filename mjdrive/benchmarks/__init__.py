"""How fast mjdrive is beside what its users would otherwise pick: `mjdrive bench`."""
