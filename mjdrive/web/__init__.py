"""The live page: a server that drives and tells, and the page that shows it."""
