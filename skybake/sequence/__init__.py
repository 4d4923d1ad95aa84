"""Many maps of one world: which frames, where they go, and what is written about them."""
