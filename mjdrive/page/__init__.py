"""The page that shows drives: what it is told, its source (browser/) and what is built of that (static/)."""
