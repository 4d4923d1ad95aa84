"""A local page with knobs, the sky that they make, and the command that bakes it."""
