"""Scripts that people run and copy: one task a file, each with main(argv).

Files:
    author                    puts presets (folder presets) and attributes on an asset, in a layer over it: looks reads
                              them, put_on writes them
    preset_gallery            writes a stage and a picture of each preset
    bake                      keeps simulated tables beside a stage
    compare, contact_sheet    show stages and images beside one another; pictures renders and arranges them
    export                    the look for other renderers: baked_look lays materials out on texels, export_preview,
                              export_materialx and export_mitsuba (with mitsuba_lights) write them, texture_files keeps
                              maps, mitsuba_run renders; folder mitsuba_plugin goes along with exported scenes
    publish                   makes an asset folder: asset_folder lays it out, gather copies what it needs
    turntable, zoom           move the camera, by camera_moves
    validate                  checks a stage in all its variants
    command, commands         what makes a pipeline a sub-command of scratchwarp
    author_demo               writes the demo stages: demo_ball, demo_kettle, demo_panel, demo_plain, and those that
                              diffract: demo_spoon, demo_disc, demo_vinyl; demo_shapes has their meshes, demo_usd puts
                              them on a stage
    deformed_highlights       draws anisotropic highlights on normal maps, plain and with facets that follow
    measured_material         fits highlight stencils to a measured BRDF and writes them as a Material
    topography                makes a preset of a height map; profile_from_topography takes the cross-section out of it
    scratch_map               makes a seamless normal map of scratches, and (scratch_plate) a stage that shows
                              it
"""
