#!/bin/sh
# Two assets the whole way: scratches put on, checked, baked, rendered, exported and published. Their own files stay.
#
#   docs/asset_walk.sh DATA OUT [WIDTH] [SPP] [TEXELS]
#
# DATA holds StandardShaderBall and Teapot of the USD working group (github.com/usd-wg/assets); OUT is made. Set
# SCRATCHWARP to another command than scratchwarp, such as "python -m scratchwarp".
set -eu
data=$1 out=$2 width=${3:-320} spp=${4:-64} texels=${5:-512}
run() { ${SCRATCHWARP:-scratchwarp} "$@" --quiet; }
sums() { find "$data" -type f -exec sha256sum {} + | sort; }

mkdir -p "$out"
sums > "$out/before.txt"

walk() { # NAME ASSET TARGETS...
  name=$1 asset=$2
  shift 2
  run validate "$out/$name.usda" --skipVariants --against "$asset"
  run bake "$out/$name.usda"
  run render "$out/$name.usda" "$out/$name.png" -w "$width" --spp "$spp"
  run export "$out/$name.usda" "$out/exported/$name" -w "$width" --spp "$spp" --texels "$texels" --to "$@"
  run publish "$out/$name.usda" "$out/published/$name" --name "$name" -w "$width" --spp "$spp" --texels "$texels"
}

asset=$data/Teapot/Teapot.usd
run author "$asset" "$out/teapot.usda" --preset scratched-plastic --material Ceramic --wear worn
walk teapot "$asset" preview materialx mitsuba

asset=$data/StandardShaderBall/standard_shader_ball_scene.usda
run author "$asset" "$out/shader_ball.usda" --preset worn-brass --surface --material neutral
walk shader_ball "$asset" preview materialx

sums > "$out/after.txt"
cmp "$out/before.txt" "$out/after.txt" && echo "the assets' own files are what they were"
