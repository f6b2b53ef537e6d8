"""The error that means: the input is at fault."""


class StageError(ValueError):
    """The stage, or a file it needs, cannot be rendered; the message names the file, the prim and what to do next."""
