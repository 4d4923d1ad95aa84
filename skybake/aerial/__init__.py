"""The air between a camera and what it sees, put into pictures of other programs."""
