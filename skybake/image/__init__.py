"""What a map shows: who looks where at what light, in layers of pixels, and how it is stored."""
