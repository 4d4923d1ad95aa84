"""Where clouds are: shapes, tiles of voxels, and the extinction at a point of either."""
