"""What `export` makes of a run folder, a module for each kind of result."""
