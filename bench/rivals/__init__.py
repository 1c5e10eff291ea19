"""Other renderers that get the same scenes."""
