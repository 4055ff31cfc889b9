#!/bin/sh
# Regenerates the pictures of this folder.
set -eu
cd "$(dirname "$0")"
kfrac() { cargo run --locked --quiet --release --manifest-path ../../Cargo.toml -- "$@" --quiet; }

kfrac grow poppies --size 420 -o poppies.png
kfrac grow rose-window --size 420 -o rose-window.png
kfrac grow gold-lace --size 420 -o gold-lace.png
kfrac grow hemlock-at-dusk --size 420 -o hemlock-at-dusk.png
kfrac grow blue-ridges --size 420 -o blue-ridges.png
kfrac grow peacock --size 420 -o peacock.png
kfrac grow high-city --size 420 -o high-city.png
kfrac grow pursuit-quilt --size 420 -o pursuit-quilt.png
kfrac grow marquetry --size 420 -o marquetry.png
kfrac grow dahlia --size 480 -o dahlia.svg
kfrac grow meadow --size 640 -o meadow.svg
kfrac grow penrose-stars --size 480 -o penrose-stars.svg
kfrac grow koch-snowflake --steps 5 --size 480 --stroke '#3b7ea1' --stroke-width 1.2 -o koch-snowflake.svg
kfrac grow dragon --steps 11 --size 480 --color-by index --palette sunset -o dragon.svg
kfrac grow pythagoras-squares --steps 9 --size 480 -o pythagoras-squares.svg
kfrac grow rinceau --size 480 -o rinceau.svg
kfrac grow snow-crystal --size 480 -o snow-crystal.svg
kfrac grow monkeys-tree --size 480 -o monkeys-tree.svg
kfrac grow terdragon-rose --size 480 -o terdragon-rose.svg
kfrac grow sea-fan --seed 3 --size 360 -o sea-fan.png
kfrac grow fern --size 480 -o fern.png
kfrac grow cut-sheets --seed 7 --size 480 -o cut-sheets.svg
kfrac grow archipelago --size 480 -o archipelago.png
kfrac grow menger --from 35,25 --perspective 35 --size 420 -o menger.png
kfrac grow icosahedron-flake --shade both --size 420 -o icosahedron-flake.png
kfrac grow pound-sign-in-space --from 30,30 --size 420 -o pound-sign-in-space.png
kfrac grow icosahedron-flake --slice 0,1,1.618=0.6,w=0.02 --size 420 -o icosahedron-slice.png
kfrac grow menger --steps 3 --cut 1,1,1=1.5 --from 40,40 --plot --size 420 -o menger-cut.svg
kfrac map complex-pair --over 's=[-1,-1]..[1,1]' --size 480 -o pairs-map.png
kfrac grow random-tree-with-leaves --size 420 -o random-tree-with-leaves.png
kfrac grow sphere-flake --size 420 -o sphere-flake.png
kfrac grow bush-in-space --size 420 -o bush-in-space.png
kfrac grow autumn --size 420 -o autumn.png
kfrac sheet pythagoras --steps 0..7 --size 150 --columns 4 -o pythagoras-sheet.svg
kfrac show monkeys-tree -o monkeys-tree-rule.svg

# Films.
kfrac animate tree-libeskind-hadas --set angle=-8..28 --bounce --frames 48 --size 320 -o bending-tree.gif
kfrac animate pythagoras --steps 0..9 --hold 15 --frames 90 --size 360 --color-by step --palette earth-to-leaf -o growing-tree.gif
kfrac animate koch-snowflake --zoom loop --at '0.(1)' --detail 0.5 --frames 48 --size 320x240 --stroke-width 1.5 -o endless-koch.gif
kfrac animate complex-pair --set 's=circle([0,0],0.7)' --loop --frames 60 --size 240 -o orbit.gif
kfrac animate menger --from 0..90,25 --loop --frames 36 --shade both --size 240x240 -o turning-sponge.gif
kfrac animate koch --to levy --detail 0.8 --frames 60 --bounce --hold 6 --size 360 --color-by none --stroke '#4b3f8f' -o koch-to-levy.gif
