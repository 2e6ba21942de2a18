"""Both turns at one junction, as videos that a browser plays."""
