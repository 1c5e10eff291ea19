"""Errors and costs of pictures, from still ones to those of the window."""
