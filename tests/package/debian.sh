#!/bin/bash
# Makes the Debian packages, installs them on a bare Debian 12 in a folder of its own, and uses each
# there: a picture, a module, a program that is linked. Needs root, help2man, debootstrap and a mirror
# of Debian; without, the test is skipped and says so.
#   debian.sh BUILD-FOLDER SOURCE-FOLDER SCRATCH-FOLDER
set -eu
build=$1 source=$2 scratch=$3/debian
mirror=${PHOTILE_DEBIAN_MIRROR:-http://deb.debian.org/debian}

skip() {
  echo "skipped: $*"
  exit 77
}
fail() {
  echo "debian.sh: $*" >&2
  exit 1
}
[ "$(id -u)" = 0 ] || skip "a chroot needs root"
command -v help2man > /dev/null || skip "there is no help2man; apt-get install help2man"
command -v debootstrap > /dev/null || skip "there is no debootstrap; apt-get install debootstrap"

root=$scratch/root
rm -rf "$scratch/packages"
mkdir -p "$scratch"
(cd "$build" && cpack --config CPackConfig.cmake -B "$scratch/packages") > "$scratch/cpack.log" ||
  { cat "$scratch/cpack.log"; fail "cpack failed"; }
for name in photile photile-openimageio libphotile-dev python3-photile; do
  ls "$scratch"/packages/${name}_*.deb > /dev/null || fail "there is no package $name"
done

# The manual page of a command has every option of its help.
page=$(dpkg-deb --fsys-tarfile "$scratch"/packages/photile_*.deb |
  tar -xO ./usr/share/man/man1/photile-render.1)
"$build/photile" render --help | grep -o '^  -[^ ]*' | tr ',' '\n' | tr -d ' ' |
  while read -r option; do
    grep -qF -- "${option//-/\\-}" <<< "$page" || fail "photile-render.1 lacks $option"
  done

# A bare Debian is made once and copied for each run.
if [ ! -e "$scratch/bare.tar" ]; then
  rm -rf --one-file-system "$root"
  debootstrap --variant=minbase bookworm "$root" "$mirror" > "$scratch/debootstrap.log" 2>&1 ||
    skip "debootstrap found no Debian 12 at $mirror; PHOTILE_DEBIAN_MIRROR names another"
  tar -C "$root" -cf "$scratch/bare.tar" .
fi
rm -rf --one-file-system "$root"
mkdir -p "$root"
tar -C "$root" -xf "$scratch/bare.tar"
cp "$scratch"/packages/*.deb "$root/root"
cp -r "$source/scenes/cornell-box" "$source/scenes/gallery" "$source/docs/examples" "$root/root"
cp /etc/resolv.conf "$root/etc/resolv.conf"
trap 'umount "$root/proc" "$root/sys" 2> /dev/null || true' EXIT
mount -t proc proc "$root/proc" || skip "nothing can be mounted here"
mount -t sysfs sys "$root/sys"  # by which PoCL counts processors
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive bash -euc "cd /root; $*"; }

inside "apt-get update; apt-get install --yes --no-install-recommends pocl-opencl-icd \
  ./photile_*.deb ./python3-photile_*.deb" > "$scratch/install.log" 2>&1 ||
  { tail -n 20 "$scratch/install.log"; fail "the packages do not install"; }
inside "photile --version" | grep -q '^photile [0-9.]* (commit ' || fail "no version is told"
inside "photile render cornell-box/cornell-box.obj -o box.exr -o box.png --size 64x48 \
  --quality draft --photons 20000 --quiet; photile relight box.exr" | grep -q '^light: lamp' ||
  fail "no picture is rendered and relit"
inside "printf 'P6 1 1 255\\n\\377\\377\\377' > white.ppm
  ! photile compare white.ppm white.ppm 2> error
  grep -q 'install the package photile-openimageio' error && [ \$(wc -l < error) = 1 ]" ||
  fail "a PPM without photile-openimageio is no error of a line that names it"
report="photile measure gallery/downlights.gltf --plane floor+0.8 --photons 5000 --rays 16 -q -o box.html"
inside "! $report > /dev/null 2> error
  grep -q 'apt-get install python3-jinja2' error && [ \$(wc -l < error) = 1 ]" ||
  fail "a report without Debian's packages is no error of a line that names them"
inside "apt-get install --yes --no-install-recommends python3-jinja2 python3-contourpy; $report" \
  >> "$scratch/install.log" 2>&1 || { tail -n 20 "$scratch/install.log"; fail "no report is drawn"; }
inside "apt-get install --yes --no-install-recommends ./photile-openimageio_*.deb" \
  >> "$scratch/install.log" 2>&1 ||
  { tail -n 20 "$scratch/install.log"; fail "photile-openimageio does not install"; }
inside "photile compare white.ppm white.ppm" > /dev/null || fail "photile-openimageio reads no PPM"
# With the numpy that the package depends on, and with others: PYTHONPATH.
use_module() {
  inside "PYTHONPATH=$1 python3 -c '
import numpy
import photile
scene = photile.load(\"cornell-box/cornell-box.obj\")
photons = photile.trace(scene, 1000)
maps = photile.PhotonMaps(photons)
near = maps.nearest(photons.position[:10], photons.normal[:10], k=3)
assert scene.vertices.any() and near.photons[:, 0].tolist() == list(range(10))
assert near.distance[:, 0].max() < 1e-6
assert photile.relight(\"box.exr\").mix().shape == (48, 64, 3)
print(\"numpy\", numpy.__version__)'"
}
use_module '' | grep -q '^numpy 1' || fail "the module does not work"
numpy_2=missing
if /usr/bin/python3 -m pip install --quiet --target "$root/root/numpy_2" 'numpy>=2,<3' \
    > "$scratch/numpy.log" 2>&1; then
  numpy_2=found
  use_module numpy_2 | grep -q '^numpy 2' || fail "the module does not work with numpy 2"
fi
for file in man/man1/photile.1 man/man1/photile-render.1 \
  applications/org.photile.Photile.desktop metainfo/org.photile.Photile.metainfo.xml \
  icons/hicolor/scalable/apps/org.photile.Photile.svg blender/scripts/addons/photile/__init__.py; do
  # minbase leaves pages out, as Debian's own containers do; then the package lists them.
  [ -s "$root/usr/share/$file" ] || inside "dpkg -L photile" | grep -q "/$file" ||
    fail "share/$file is missing"
done

inside "apt-get install --yes --no-install-recommends cmake g++ make ./libphotile-dev_*.deb" \
  >> "$scratch/install.log" 2>&1 ||
  { tail -n 20 "$scratch/install.log"; fail "libphotile-dev does not install"; }
inside "cmake -S examples -B built -DCMAKE_BUILD_TYPE=Release && cmake --build built \
  --target own_photons && built/own_photons" > "$scratch/example.log" 2>&1 ||
  { tail -n 20 "$scratch/example.log"; fail "a program does not link libphotile-dev"; }
grep -q '^point 0: nearest photon' "$scratch/example.log" || fail "the program prints no photon"
inside "apt-get purge --yes photile photile-openimageio python3-photile libphotile-dev" > /dev/null 2>&1 ||
  fail "the packages cannot be removed"
umount "$root/proc" "$root/sys"
rm -rf --one-file-system "$root"
[ "$numpy_2" = found ] || skip "all but numpy 2, which pip does not find; PyPI is not reachable"
echo "photile, python3-photile and libphotile-dev install on Debian 12 and work there"
