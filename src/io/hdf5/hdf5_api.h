#pragma once
// HDF5 by the names of its version 1.10, which later ones give to other functions unless told.

#define H5_USE_110_API
#include <hdf5.h>
