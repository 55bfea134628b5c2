# Meshes of tests that kill the program.

# bar NX NY NZ DX DY DZ: a row of NX x NY x NZ hexahedra of these sizes (m) as .inp, with the node set FIX at x = 0 and the
# surface TOP at the largest z.
bar() {
  awk -v nx="$1" -v ny="$2" -v nz="$3" -v dx="$4" -v dy="$5" -v dz="$6" '
    function node(i, j, k) { return 1 + k + (nz + 1) * (j + (ny + 1) * i) }
    BEGIN {
      print "*NODE";
      for (i = 0; i <= nx; ++i) for (j = 0; j <= ny; ++j) for (k = 0; k <= nz; ++k)
        printf "%d, %g, %g, %g\n", node(i, j, k), dx * i, dy * j, dz * k;
      print "*ELEMENT, TYPE=C3D8, ELSET=ALL";
      for (i = 0; i < nx; ++i) for (j = 0; j < ny; ++j) for (k = 0; k < nz; ++k)
        printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
          node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1);
      print "*NSET, NSET=FIX";
      for (m = 1; m <= (ny + 1) * (nz + 1); ++m) print m;
      print "*SURFACE, NAME=TOP, TYPE=ELEMENT";
      for (e = nz; e <= nx * ny * nz; e += nz) printf "%d, S2\n", e;
    }'
}
