"""What a package for mjdrive looks like."""
