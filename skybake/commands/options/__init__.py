"""Options of commands by their subject."""
