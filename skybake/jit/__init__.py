"""From Python to machine code: compiled kernels, where they are kept, rows on threads."""
