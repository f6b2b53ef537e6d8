"""The viewer in a browser: a page, and the server that lets it look at one stage.

Files:
    server      answers requests: the page, the picture, edits; nothing else
    guard       who may ask: one-time links, cookies, hosts, sizes
    answers     what is said of a stage and a pixel, as JSON
    run         serve(stage): from the command line to the address
    page/       index.html, style.css, app.js: all that is ever served
"""

from .run import serve

__all__ = ["serve"]
