"""The sun's position: from a place and a time to elevation and azimuth."""
