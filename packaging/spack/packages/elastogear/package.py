from spack.package import *


class Elastogear(CMakePackage):
    """Stresses in gears under transient load by elastic multibody models."""

    license("BSD-3-Clause")
    version("main")  # from the clone: spack dev-build elastogear@main
    variant("python", default=True, description="Build the Python module")

    depends_on("cxx", type="build")
    depends_on("c", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18:3.22 +mpi +metis +mumps ~complex")
    depends_on("slepc@3.18:3.22")
    depends_on("hdf5 +mpi")
    depends_on("mumps +mpi")
    depends_on("metis ~int64")
    depends_on("eigen@3.4")
    depends_on("lapack")
    depends_on("blas")
    depends_on("libyaml")
    depends_on("nlohmann-json@3:")
    # The report page that the program makes is a script of Python; its bundle is made by npm at the first page.
    depends_on("python@3.9:", type=("build", "run"))
    depends_on("py-numpy", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-pyyaml", type="run")
    depends_on("npm", type="run")
    depends_on("py-pybind11@2.10:", type="build", when="+python")
    extends("python", when="+python")

    def cmake_args(self):
        python = self.spec["python"]
        folder = f"lib/python{python.version.up_to(2)}/site-packages"
        return [
            self.define("ELASTOGEAR_TESTS", False),
            self.define("ELASTOGEAR_EXAMPLES", False),
            self.define("ELASTOGEAR_PYTHON", python.command.path),
            self.define("ELASTOGEAR_PYTHON_DIR", folder),
            self.define_from_variant("ELASTOGEAR_PYTHON_MODULE", "python"),
        ]
