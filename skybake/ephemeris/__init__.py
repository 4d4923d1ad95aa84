"""Where the sun stands: from a place and a time to elevation and azimuth."""
