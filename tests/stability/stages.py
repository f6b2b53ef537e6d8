"""Small stages of many kinds, as text: what the fuzzer mutates.

``stage(rng)`` puts together geometry, lights, materials, a camera and render settings; every kind of each is met.
"""

import re

import numpy as np

HEADER = '#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = "Y"\n    startTimeCode = 1\n    endTimeCode = 4\n)\n'
BOUND = 'prepend apiSchemas = ["MaterialBindingAPI"]'
TURN = 'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", "xformOp:scale"]'


def placed(at=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1)):
    """xformOps."""
    return (
        f"double3 xformOp:translate = {tuple(at)}\n    float3 xformOp:rotateXYZ = {tuple(turn)}\n"
        f"    float3 xformOp:scale = {tuple(scale)}\n    {TURN}\n"
    )


PLATE = f"""
def Mesh "plate" ({BOUND})
{{
    {placed((0.1, 0, 0), (-60, 10, 0))}
    uniform token subdivisionScheme = "none"
    point3f[] points = [(-1, -1, 0), (0, -1, 0.1), (1, -1, 0), (-1, 1, 0), (0, 1, 0.1), (1, 1, 0)]
    int[] faceVertexCounts = [4, 4]
    int[] faceVertexIndices = [0, 1, 4, 3, 1, 2, 5, 4]
    normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] ( interpolation = "vertex" )
    texCoord2f[] primvars:st = [(0, 0), (0.5, 0), (1, 0), (0, 1), (0.5, 1), (1, 1)] ( interpolation = "vertex" )
    float[] primvars:wear = [0, 0.5, 1, 1, 0.2, 0.7] ( interpolation = "vertex" )
    vector3f[] primvars:flow = [(1, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0)] (
        interpolation = "vertex"
    )
    rel material:binding = </mat>
    def GeomSubset "half" ({BOUND})
    {{
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [1]
        rel material:binding = </other>
    }}
}}
"""
MOVING = f"""
def Cube "moving" ({BOUND})
{{
    double size = 1.1
    matrix4d xformOp:transform.timeSamples = {{
        1: ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
        2: ((0, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
        3: ((1, 0.4, 0, 0), (0, -1, 0, 0), (0, 0, 1, 0), (0.2, 0, 0, 1)),
        4: ((0, 0, 0, 0), (0, 0, 0, 0), (0, 0, 0, 0), (0, 0, 0, 0)),
    }}
    uniform token[] xformOpOrder = ["xformOp:transform"]
    rel material:binding = </mat>
}}
"""
CROWD = f"""
def PointInstancer "crowd"
{{
    rel prototypes = [</crowd/ball>, </crowd/tube>]
    int[] protoIndices = [0, 1, 0]
    point3f[] positions = [(-0.7, 0, 0), (0.5, 0.3, 0), (0, -0.7, 0.3)]
    float3[] scales = [(1, 1, 1), (0.5, 1, -1), (0, 1, 1)]
    def Sphere "ball" ({BOUND})
    {{
        double radius = 0.6
        color3f[] primvars:displayColor = [(0.2, 0.5, 0.9)]
        rel material:binding = </mat>
    }}
    def Cylinder "tube"
    {{
        double radius = 0.2
        double height = 1
        color3f[] primvars:displayColor = [(0.2, 0.5, 0.9)]
    }}
}}
"""
GEOMETRY = {
    "ball": f'def Sphere "ball" ({BOUND})\n{{\n    double radius = 1\n    rel material:binding = </mat>\n}}\n',
    "cone": f'def Cone "cone" ({BOUND})\n{{\n    double height = 1.5\n    rel material:binding = </mat>\n}}\n',
    "plate": PLATE,
    "moving": MOVING,
    "crowd": CROWD,
}
LIGHTS = {
    "sun": f'def DistantLight "sun"\n{{\n    float inputs:intensity = 2\n    {placed((0, 0, 0), (-50, 30, 0))}\n}}\n',
    "bulb": f'def SphereLight "bulb"\n{{\n    float inputs:radius = 0.3\n    {placed((1.5, 2, 1))}\n}}\n',
    "point": 'def SphereLight "point"\n{\n    bool treatAsPoint = 1\n    float inputs:intensity = 5\n}\n',
    "panel": f"""def RectLight "panel" (prepend apiSchemas = ["ShapingAPI", "ShadowAPI"])
{{
    float inputs:intensity = 4
    float inputs:shaping:cone:angle = 60
    float inputs:shaping:focus = 1
    asset inputs:texture:file = @pixels.png@
    {placed((-1, 2, 2), (-40, -25, 0), (1, 2, 1))}
}}
""",
    "disk": f'def DiskLight "disk"\n{{\n    float inputs:specular = 0.5\n    {placed((0, 2.5, 0), (-90, 0, 0))}\n}}\n',
    "tube": f'def CylinderLight "lamp"\n{{\n    float inputs:radius = 0.1\n    {placed((0, 1.5, 1))}\n}}\n',
    "sky": 'def DomeLight "sky"\n{\n    float inputs:intensity = 0.4\n    asset inputs:texture:file = @tiny.exr@\n}\n',
    "even sky": 'def DomeLight "sky"\n{\n    float inputs:intensity = 0.4\n}\n',
    "glowing mesh": """def Mesh "glow" (prepend apiSchemas = ["MeshLightAPI", "MaterialBindingAPI"])
{
    point3f[] points = [(-1, 1.5, -1), (1, 1.5, -1), (0, 2, 0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    float inputs:intensity = 3
    rel material:binding = </other>
}
""",
    "linked": """def RectLight "linked" (
    prepend apiSchemas = ["CollectionAPI:lightLink"]
)
{
    rel collection:lightLink:includes = </ball>
    uniform bool collection:lightLink:includeRoot = 0
}
""",
}
READ = """
    def Shader "image"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @pixels.png@
        float2 inputs:st.connect = </mat/st.outputs:result>
        token inputs:wrapS = "repeat"
        float4 inputs:scale = (0.8, 0.8, 0.8, 1)
        float3 outputs:rgb
        float outputs:r
    }
    def Shader "st"
    {
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "st"
        float2 outputs:result
    }
"""
SURFACES = {
    "paint": """uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor = (0.6, 0.3, 0.2)
        float inputs:roughness = 0.4
        float inputs:clearcoat = 0.5
        color3f inputs:emissiveColor = (0, 0.1, 0)""",
    "textured": """uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </mat/image.outputs:rgb>
        float inputs:roughness.connect = </mat/image.outputs:r>
        normal3f inputs:normal.connect = </mat/image.outputs:rgb>
        float inputs:metallic = 1""",
    "glass": """uniform token info:id = "UsdPreviewSurface"
        float inputs:opacity = 0.2
        float inputs:ior = 1.4
        float inputs:roughness = 0""",
    "metal": """uniform token info:id = "ScratchSurface"
        token inputs:base = "conductor"
        token inputs:metal = "iron"
        float inputs:roughness = 0.1
        float inputs:anisotropy = 0.5""",
    "paper": """uniform token info:id = "ScratchSurface"
        token inputs:base = "diffuse"
        color3f inputs:color = (0.8, 0.7, 0.6)""",
}
LAYERS = {
    "worley": ("worley", "width = 3000", "depth = 900", "length = 200000", "coverage = 0.4", "patterns = 3"),
    "random": ("random", "width = 900", "depth = 300", "length = 90000", "density = 0.0001", "widthVariation = 0.5"),
    "linear": ("linear", "width = 400", "depth = 150", "pitch = 2000", "angle = 30"),
    "concentric": ("concentric", "width = 4000", "depth = 900", "pitch = 20000"),
    "spiral": ("spiral", "width = 4000", "depth = 900", "pitch = 20000", "curvature = 10"),
    "crosshatch": ("crosshatch", "width = 4000", "depth = 900", "pitch = 20000", "crossAngle = 60"),
    "curves": ("curves", "width = 9000", "depth = 2000"),
}
MODELS = ("auto", "table", "table", "diffraction", "groove", "normalMap", "mirror", "singleBounce", "fullTable")
CURVES = """
def BasisCurves "lines" (prepend apiSchemas = ["ScratchCurvesAPI"])
{
    uniform token type = "linear"
    int[] curveVertexCounts = [2, 3]
    point3f[] points = [(-0.8, -0.5, 0), (0.8, 0.4, 0), (0, -0.8, 0.3), (0.1, 0, 0.5), (0.2, 0.8, 0.2)]
    float[] widths = [0.02, 0.03] ( interpolation = "uniform" )
}
"""
WAVE = """
    float scratch:wave:coherenceRadius = 60
    uniform token scratch:wave:phase = "{phase}"
    uniform int scratch:wave:samples = 8
"""
CAMERA = f"""
def Camera "camera"
{{
    token projection = "perspective"
    float horizontalAperture = 20
    float verticalAperture = 20
    float focalLength = 35
    float fStop = STOP
    float focusDistance = 5
    float2 clippingRange = (0.1, 1000)
    {placed((0, 0.6, 5), (-6, 0, 0))}
}}
"""
SETTINGS = """
def Scope "Render"
{
    def RenderSettings "settings"
    {
        uniform int2 resolution = (16, 16)
        rel camera = </camera>
        token aspectRatioConformPolicy = "expandAperture"
        uniform token scratch:render:integrator = "direct"
        uniform int scratch:render:spp = 2
        uniform float4 dataWindowNDC = (0, 0, 1, 1)
    }
}
"""


def _pick(rng, options, low=1, high=1):
    names = list(options)
    return [names[i] for i in rng.permutation(len(names))[: rng.integers(low, high + 1)]]


def layer(rng, name, curves):
    """Attributes of one scratch layer."""
    kind, *sizes = LAYERS[_pick(rng, LAYERS)[0]]
    model = MODELS[rng.integers(len(MODELS))]
    made = [f'uniform token scratch:layer:{name}:distribution = "{kind}"']
    made += [f'uniform token scratch:layer:{name}:model = "{model}"', f"rel scratch:layer:{name}:profile = </mat/cut>"]
    for size in sizes:
        if kind == "worley" and "patterns" in size:
            made.append(f"uniform int scratch:layer:{name}:{size}")
        elif "patterns" not in size:
            made.append(f"float scratch:layer:{name}:{size}")
    if kind == "curves":
        made.append(f"rel scratch:layer:{name}:curves = </lines>")
        curves.append(CURVES)
    if model == "diffraction":
        made = [re.sub("(?<=:width = )\\d+", "3", re.sub("(?<=:depth = )\\d+", "1", m)) for m in made]
    extra = rng.integers(8)
    if extra == 0:
        made.append(f'uniform token scratch:layer:{name}:maskPrimvar = "wear"')
    if extra == 1:
        made.append(f'uniform token scratch:layer:{name}:orientationPrimvar = "flow"')
    if extra == 2:
        made.append(f'uniform token scratch:layer:{name}:material = "diffuse"')
    if extra == 3:
        made.append(f'uniform token scratch:layer:{name}:material = "dielectric"')
    return made


def material(rng, name, curves):
    """One material with up to two layers."""
    count = rng.integers(0, 3)
    lines = [text for n in ("fine", "deep")[:count] for text in layer(rng, n, curves)]
    apis = [f'"ScratchLayerAPI:{n}"' for n in ("fine", "deep")[:count]]
    if rng.integers(3) == 0 or any("diffraction" in text for text in lines):
        apis.append('"ScratchWaveAPI"')
        lines.append(WAVE.format(phase=("smallAngle", "angleDependent")[rng.integers(2)]))
    surface = SURFACES[_pick(rng, SURFACES)[0]]
    shape = ("vGroove", "round", "rectangle", "quartic", "gaussian", "sine", "trapezoid")[rng.integers(7)]
    ours = "ScratchSurface" in surface
    port = "outputs:scratchwarp:surface" if ours else "outputs:surface"
    body = "\n    ".join(lines)
    head = f"(prepend apiSchemas = [{', '.join(apis)}])" if apis else ""
    return f"""
def Material "{name}" {head}
{{
    token {port}.connect = </{name}/node.outputs:surface>
    {body}
    def ScratchProfile "cut"
    {{
        uniform token scratch:shape = "{shape}"
    }}
    def Shader "node"
    {{
        {surface}
        token outputs:surface
    }}
{READ}}}
""".replace("</mat/", f"</{name}/")


def stage(rng: np.random.Generator) -> str:
    """The text of a stage; ``pixels.png`` beside it is its texture."""
    curves: list[str] = []
    parts = [HEADER]
    parts += [GEOMETRY[name] for name in _pick(rng, GEOMETRY, 1, 2)]
    lights = {name: text for name, text in LIGHTS.items() if name != "even sky"}
    parts += [lights[name] for name in _pick(rng, lights, 1, 3)]
    parts += [material(rng, "mat", curves), material(rng, "other", curves)]
    parts += curves[:1]
    parts.append(CAMERA.replace("STOP", str((0, 0, 2)[rng.integers(3)])))
    if rng.integers(3) == 0:
        parts.append(SETTINGS)
    return "".join(parts)
