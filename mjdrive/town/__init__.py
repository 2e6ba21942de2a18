"""Road networks: from OpenDRIVE to lanes, lights and routes."""
