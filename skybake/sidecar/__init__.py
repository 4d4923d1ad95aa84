"""Files beside maps that tell other programs what lights a scene."""
