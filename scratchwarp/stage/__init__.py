"""USD stage to Scene; the only importer of pxr.

Importing this package registers scratchwarp's schemas with USD, which must happen before the first stage is opened.

Files, from the outside in:
    read            read(path) -> Scene
    open            a file to an open stage, or what is wrong with it; package: what is wrong with a usdz
    reading         what every part needs to know, and the warnings
    options         render settings, products and vars
    camera          the camera
    traverse        which prims can be seen, and where: instances, point instancers, visibility, purposes
    geometry        which reader reads which geometric prim
    mesh            UsdGeomMesh; triangulate, primvar, normals, vectors are its parts
    shapes          spheres, cubes, planes, cylinders, cones, capsules
    place           instances; binding says which material goes where
    material        UsdShadeMaterial: preview, scratch_surface, shader_input, texture_input, texture, layer
    curves          explicit scratches; curve_basis samples them
    illuminate      all lights; lights says which function reads which type: light_near, light_far, light_shape; light
                    is what they share
    color           colours in linear Rec.709
    live            LiveStage: a stage that is edited while it is looked at; controls says what of it can be turned
    complain        what an author should hear of the scene as a whole
    validation      validate(path) -> findings; validation_framework hands the rules (validation_rule) to OpenUSD's own
                    validators: validation_names, _values, _links, _materials, _profiles, _curves
"""

from scratchwarp.usd_schemas import register

from .live import LiveStage
from .read import PURPOSES, read

register()

__all__ = ["PURPOSES", "LiveStage", "read"]
