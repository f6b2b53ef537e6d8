"""What a kernel is specialised by: only the code that these fields name is compiled."""

from dataclasses import dataclass


@dataclass(frozen=True)
class KernelKey:
    """One specialisation.

    Attributes:
        lights: kinds of light, in the order of their ranges; distributions: kinds of scratch pattern.
        filter: box, gaussian or blackmanHarris.
        directed: some material has a direction (scratches or anisotropy), so tangents are read.
        lens, orthographic: of the camera.
        shadows: something can occlude; opacity: some surface lets light through; emission: some surface glows.
        normal_maps, display_colors, textures: of the materials.
        preview, measured: UsdPreviewSurface bases, ScratchSurface bases.
        diffuse_scratches: some scratch is a Lambert surface. sum_coverage: coverages of layers add up (Eq. 4).
        variation: scratches of one layer differ. masks, orientations: maps say where layers are, which way they run.
        tints: scratches take the local reflectance of textured bases.
        light_links: some light picks what it lights.
        light_multipliers: some light's diffuse or specular multiplier is not 1.
        mesh_lights: some geometry is a light. path: indirect bounces.
        highlights: those smaller than a pixel are drawn from.
        responses: kinds of response over solid angle, of scratches or bases.
        glints: some scratches diffract. glint_segments: explicit ones; glint_bands: regular patterns.
        glint_lists, glint_hierarchy: pieces are found by triangle, in a hierarchy, or either by what a footprint needs.
        glint_crowds: of some footprints' scratches some are drawn for all. glint_gratings: some of them show orders.
        glint_areas: under lights with an extent. glint_method: slices, closed-form or paper.
        glint_footprint: gaussian, exact, paper or point.
        glint_lookup, glint_fringes: colours under wide lights, under lights without extent, are looked up.
        glint_numeric: some cross-section is no
            rectangle, or some phase depends on angles. glint_pairs: scratches of a footprint interfere.
            glint_paths: paths go on that they diffract. glint_masks, glint_orientations: maps say where they are and
            which way regular ones run.
        grooves: some scratches are laid out one by one. groove_crossings: they cross, bend or end;
            groove_bounces: light goes on inside; groove_glass: some are cut in what refracts; groove_handover: far away
            they are as statistical as the others; groove_tapers: their sizes change along them.
        closed_form: light along the cones of scratches is integrated; cone_taps: some of those lights are not even.
        sample_lights, sample_cones: scratches look for the other lights by drawing from these, from their own cone.
        small_lights: all layers' scratches are asked for small lights.
    """

    lights: tuple[str, ...] = ()
    distributions: tuple[str, ...] = ()
    filter: str = "box"
    directed: bool = False
    lens: bool = False
    orthographic: bool = False
    shadows: bool = False
    opacity: bool = False
    emission: bool = False
    normal_maps: bool = False
    display_colors: bool = False
    textures: bool = False
    preview: bool = True
    measured: bool = False
    diffuse_scratches: bool = False
    sum_coverage: bool = False
    variation: bool = False
    masks: bool = False
    tints: bool = False
    orientations: bool = False
    light_links: bool = False
    light_multipliers: bool = False
    mesh_lights: bool = False
    path: bool = False
    highlights: bool = False
    responses: tuple[str, ...] = ()
    glints: bool = False
    glint_segments: bool = False
    glint_lists: bool = False
    glint_hierarchy: bool = False
    glint_crowds: bool = False
    glint_bands: bool = False
    glint_gratings: bool = False
    glint_areas: bool = False
    glint_lookup: bool = False
    glint_fringes: bool = False
    glint_numeric: bool = False
    glint_pairs: bool = False
    glint_paths: bool = False
    glint_masks: bool = False
    glint_orientations: bool = False
    glint_method: str = "slices"
    glint_footprint: str = "gaussian"
    grooves: bool = False
    groove_crossings: bool = False
    groove_bounces: bool = False
    groove_glass: bool = False
    groove_handover: bool = False
    groove_tapers: bool = False
    closed_form: bool = False
    cone_taps: bool = False
    sample_lights: bool = False
    sample_cones: bool = False
    small_lights: bool = False

    @property
    def scratches(self) -> bool:
        """Whether any scratch code is compiled."""
        return bool(self.distributions)
