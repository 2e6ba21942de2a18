"""Town and car on MuJoCo physics, with rules and cameras."""
