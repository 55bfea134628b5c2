#!/usr/bin/env bash
set -euo pipefail
python scripts/page/bundle.py
# CMAKE_ARGS: prefix, compilers and search paths, set by conda's compiler packages.
read -ra arguments <<<"${CMAKE_ARGS:-}"
cmake -S . -B build/conda -G Ninja "${arguments[@]}" -DCMAKE_BUILD_TYPE=Release \
  -DELASTOGEAR_TESTS=OFF -DELASTOGEAR_EXAMPLES=OFF -DELASTOGEAR_PYTHON="$PYTHON" \
  -DELASTOGEAR_PYTHON_DIR="${SP_DIR#"$PREFIX/"}"
cmake --build build/conda --parallel "${CPU_COUNT:-2}" --target src/all
cmake --install build/conda
