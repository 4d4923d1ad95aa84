"""Many maps of one world: which frames, their files, and what is written about them."""
