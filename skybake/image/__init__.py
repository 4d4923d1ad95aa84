"""What a map shows, as layers of pixels: settings, scenes, rasters and images."""
