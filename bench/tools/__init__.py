"""What the scripts of several folders share, and what tests the tests."""
