"""Faults built into photile, which the tests have to notice."""
