"""Grooves one by one: exact at any distance (Bosch, Pueyo, Merillou, Ghazanfarpour 2008); names load on first use.

From NumPy: ``masking`` (what is seen and lit in a cross-section), ``pattern`` (paths and sections -> pieces),
``footprint`` (mean radiance of an ellipse), ``walks`` (bounces), ``facet`` (materials), ``section`` (checks).

The device code, all float64 for a footprint may be a millionth of the uv square, in any one unit of length, with the
plane z = 0 and z up:

- ``solid_device``: ``GrooveSet``, pieces and vertices (``Pattern(...).grooves``); whether a point is solid.
- ``cast_device``: ``cast(grooves, ids, count, p, d, limit, anything, inside)``, the first surface that a ray meets:
  distance, normal, piece (-1 the ground). For bounces, shadow rays (``anything`` 1) and rays within the solid.
- ``edges_device``: where what is seen may change along a line.
- ``footprint_device``: ``make_footprint_mean(Material, radiance)`` gives ``mean(grooves, ids, count, footprint, o, i,
  material, slices, chord)``; ``touches`` finds the pieces that a footprint needs, ``passes_through`` those that do not
  end there.
- ``stored_device``: pieces made from what is stored, a record a path and a point a corner; lines and rings that repeat.
- ``near_device``: ``find_near`` makes those that a footprint needs in ``GrooveSet.pieces``, room that the kernel gives
  (``with_room``), by the grid of ``scratches.grid`` (``Pattern(...).grid``).
- ``facet_device``: ``FacetMaterials`` (one a path) and ``facet_radiance``, what the NumPy entry point puts into it.
- ``scatter_device``, ``walk_device``: ``make_walk(Material, scatter, radiance)`` follows a path from facet to facet,
  with refraction, and says where and whither it leaves.
- ``masking_device``: ``seen_fraction`` of one cross-section, alone or periodic.

Contracts. ``ids[0 .. count - 1]`` are the pieces that matter, each once, in any order: at least those ``touches`` says
yes to (more cost time, not truth); count 0 is flat ground. A kernel may keep them in ``wp.zeros(shape=64, dtype=int)``,
and the pieces in another one of ``Piece``. Directions are unit and point away from the surface; ``o`` or ``i`` below
the plane gives 0. ``mean`` returns radiance for unit perpendicular irradiance (cosine of each facet inside) and the
share of the footprint in which a surface was found, 1 but for rounding. Its cost grows with edges times pieces times
lines; one line where all grooves are parallel and none ends nearby.
"""

from ...lazy import lazily

_PUBLIC = {
    "Diffuse": "facet",
    "Ends": "walks",
    "GGX": "facet",
    "Pattern": "pattern",
    "radiance": "footprint",
    "trace": "walks",
    "visibility": "masking",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
