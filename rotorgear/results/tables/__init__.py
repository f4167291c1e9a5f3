"""Tables that the commands print, one file a result."""
