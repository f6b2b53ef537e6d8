"""Warp without its greeting."""

import os


def start_warp() -> None:
    """Start Warp without its greeting, which would stand in the way of results on stdout, and without the remark that
    there is no CUDA driver, which comes from native code straight to stderr."""
    import warp

    warp.config.log_level = warp.LOG_ERROR
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        warp.init()
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
