# shellcheck shell=bash
# bar NX NY NZ DX DY DZ: a bar as .inp, by meshes/make.py.
make_mesh=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../meshes/make.py")
bar() { "$make_mesh" bar "$@"; }
