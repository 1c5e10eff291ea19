"""Daylight, glare and the worked examples of a lighting project."""
