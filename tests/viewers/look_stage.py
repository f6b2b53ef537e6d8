"""A small stage to look at: a brushed ball with two layers under a lamp and a sky."""

STAGE = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    renderSettingsPrimPath = "/settings"
    upAxis = "Y"
)
def RenderSettings "settings"
{
}
def Xform "World"
{
    def Sphere "ball" (prepend apiSchemas = ["MaterialBindingAPI"])
    {
        double radius = 1
        rel material:binding = </World/metal>
    }
    def Material "metal" (prepend apiSchemas = ["ScratchLayerAPI:fine", "ScratchLayerAPI:coarse"])
    {
        token outputs:scratchwarp:surface.connect = </World/metal/base.outputs:surface>
        float scratch:layer:fine:width = 20
        float scratch:layer:fine:depth = 4
        float scratch:layer:fine:coverage = 0.6
        float scratch:layer:fine:length = 5000
        rel scratch:layer:fine:profile = </World/metal/cut>
        int scratch:layer:coarse:order = 1
        float scratch:layer:coarse:width = 80
        float scratch:layer:coarse:depth = 30
        float scratch:layer:coarse:coverage = 0.2
        float scratch:layer:coarse:angle = 60
        rel scratch:layer:coarse:profile = </World/metal/cut>
        def Shader "base"
        {
            uniform token info:id = "ScratchSurface"
            token inputs:metal = "gold"
            float inputs:roughness = 0.2
            token outputs:surface
        }
        def ScratchProfile "cut"
        {
            uniform token scratch:shape = "round"
        }
    }
    def SphereLight "lamp"
    {
        float inputs:intensity = 60
        float inputs:radius = 0.3
        double3 xformOp:translate = (2, 3, 3)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
    def DomeLight "sky"
    {
        float inputs:intensity = 0.5
    }
    def Camera "camera"
    {
        float focalLength = 40
        double3 xformOp:translate = (0, 0, 6)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
}
"""
METAL = "/World/metal"
DEPTH = f"{METAL}.scratch:layer:fine:depth"
