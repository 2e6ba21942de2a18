"""A drive as one web page that needs no network."""
