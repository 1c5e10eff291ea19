"""Times of the estimate and of the other stages of a render, and the pages that they fill."""
