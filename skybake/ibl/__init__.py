"""Image-based lighting: what surfaces of any roughness receive from a sky, for engines."""
