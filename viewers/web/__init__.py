"""The viewer in browsers: a page that trame keeps in step with a stage, and the server that lets it look at that alone.

Files:
    server      trame's server in a thread: what there is to see is its state, wishes are its triggers
    wishes      what a browser may ask for: edits, moves, questions
    pictures    what it fetches: the stage now, before, in 3D
    answers     what is said of a stage and a pixel
    gate        what stands before every request, and the few paths that lead anywhere
    guard       who may ask: one-time links, cookies, hosts, sizes
    wire        the socket made narrow
    run         serve(stage): from the command line to the address
    page/       index.html, style.css and the page's components: look, panel, control, pixel
"""

from .run import serve

__all__ = ["serve"]
