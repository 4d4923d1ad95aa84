"""Light from all around as pixels: maps of ours and of others, read and laid out anew."""
