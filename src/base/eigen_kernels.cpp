#include "base/eigen_kernels.h"

#ifdef ELASTOGEAR_EIGEN_KERNELS
ELASTOGEAR_EIGEN_KERNELS(template)
ELASTOGEAR_EIGEN_DECOMPOSITIONS(template)
#endif
