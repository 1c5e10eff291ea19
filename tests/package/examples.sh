#!/bin/bash
# Installs the library, builds docs/examples and two benches with nothing but the installed files, and
# checks what they print, that of the examples against values known in closed form.
#   examples.sh CMAKE BUILD-FOLDER SOURCE-FOLDER SCRATCH-FOLDER
set -eu
cmake=$1 build=$2 source=$3 scratch=$4

fail() {
  echo "examples.sh: $*" >&2
  exit 1
}

# within LOW HIGH VALUE WHAT
within() {
  awk -v low="$1" -v high="$2" -v value="$3" 'BEGIN { exit !(value >= low && value <= high) }' ||
    fail "$4: $3 is not within [$1, $2]"
}

rm -rf "$scratch/installed" "$scratch/out"
mkdir -p "$scratch/out"
"$cmake" --install "$build" --prefix "$scratch/installed" > "$scratch/out/install.log"
! grep -q estimate_by_list "$scratch/installed/bin/photile" ||
  fail "the command has the kernels of what grids are compared with"
for header in "$source"/include/photile/*.hpp; do
  name=$(basename "$header")
  [ "$name" = photile.hpp ] || grep -q "\"photile/$name\"" "$source/include/photile/photile.hpp" ||
    fail "photile.hpp leaves out $name"
done
for program in "$source"/docs/examples/*.{cpp,c}; do
  python3 -c 'import sys; sys.exit(open(sys.argv[1]).read() not in open(sys.argv[2]).read())' \
    "$program" "$source/docs/reference/library.md" || fail "docs/reference/library.md shows another $program"
done
# The programs are copied, so that no header of the source folder can be found by chance.
cp -r "$source/docs/examples" "$scratch/out/examples"
"$cmake" -S "$scratch/out/examples" -B "$scratch/out/build" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_C_FLAGS="-std=c99 -pedantic -Wall -Wextra -Werror" -DCMAKE_PREFIX_PATH="$scratch/installed" > "$scratch/out/configure.log"
"$cmake" --build "$scratch/out/build" -j 2 > "$scratch/out/build.log"

mkdir -p "$scratch/out/benches"
cp -r "$source/bench/kernels" "$source/bench/support" "$scratch/out/benches"
"$cmake" -S "$source/tests/package/benches" -B "$scratch/out/build_benches" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/installed" \
  -DPHOTILE_BENCHES="$scratch/out/benches" > "$scratch/out/configure_benches.log"
"$cmake" --build "$scratch/out/build_benches" -j 2 > "$scratch/out/build_benches.log"
"$scratch/out/build_benches/relight_bench" --help > "$scratch/out/relight_bench.txt"

photons=$("$scratch/out/build/own_photons")
echo "$photons"
# 400 lm on 4 m2; the estimate of 1000 photons scatters by 3%.
within 85 115 "$(sed -n 's/^point 0: .* \([0-9.]*\) lx$/\1/p' <<< "$photons")" "lux of even photons"
within 0 0 "$(sed -n 's/^point 2: .* \([0-9.]*\) lx$/\1/p' <<< "$photons")" "lux far from photons"

room=$("$scratch/out/build/measured_room")
echo "$room"
# Straight from the lamp 1500 lm / 4 pi / (2 m)^2 = 29.8 lx in the middle. All light, with a
# reflectance of 0.8, is 1500 lm / (1 - 0.8) over 85 m2 on average: 88 lx.
within 60 160 "$(sed -n 's/^x = 2.5 m: \([0-9]*\) lx$/\1/p' <<< "$room")" "lux below the lamp"

points=$("$scratch/out/build/nearest_points")
echo "$points"
[ "$(grep -c "^query [012]: point [0-9]*, " <<< "$points")" = 12 ] || fail "not 4 neighbours of 3 queries"
# A million points in a cube of 1 m, and a query 1 m above its corner.
within 1 1.02 "$(sed -n 's/^query 2: .*, \(.*\) away$/\1/p;T;q' <<< "$points")" "distance of a point"

(cd "$scratch/out" &&
  build/relit_picture "$source/scenes/cornell-box/cornell-box.obj" lit.exr half.png)
[ -s "$scratch/out/lit.exr" ] && [ -s "$scratch/out/half.png" ] || fail "a picture is missing"
! "$scratch/out/build/relit_picture" missing.obj a.exr b.png 2> "$scratch/out/error.log" ||
  fail "a missing scene is no error"
grep -q "missing.obj" "$scratch/out/error.log" || fail "the error does not name the file"
[ "$(wc -l < "$scratch/out/error.log")" = 1 ] || fail "the error is not one line"

# Textures are read by a module that the command and the programs find where it is installed.
(cd "$scratch/out" && printf 'P6 1 1 255\n\377\377\377' > white.ppm &&
  printf 'newmtl floor\nmap_Kd white.ppm\nnewmtl lamp\nKe 1 1 1\n' > floor.mtl &&
  printf '%s\n' 'mtllib floor.mtl' 'v 0 0 0' 'v 0 0 1' 'v 1 0 0' 'v 0 1 0' 'v 1 1 0' 'v 0 1 1' 'vt 0 0' \
    'vt 0 1' 'vt 1 0' 'usemtl floor' 'f 1/1 2/2 3/3' 'usemtl lamp' 'f 4 5 6' > floor.obj &&
  build/relit_picture floor.obj floor.exr floor.png > /dev/null) || fail "a program reads no texture"
photile=$scratch/installed/bin/photile white=$scratch/out/white.ppm
if [ -x "$photile" ]; then
  "$photile" compare "$white" "$white" > /dev/null || fail "the installed command reads no PPM"
  find "$scratch/installed" -name photile_openimageio.so -delete
  ! "$photile" compare "$white" "$white" 2> "$scratch/out/error.log" ||
    fail "a picture that cannot be read is no error"
  grep -q "install the package photile-openimageio" "$scratch/out/error.log" ||
    fail "the error does not name the package"
  [ "$(wc -l < "$scratch/out/error.log")" = 1 ] || fail "the error is not one line"
fi
