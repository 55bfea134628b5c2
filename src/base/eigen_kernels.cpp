#include "base/eigen_kernels.h"

#ifdef ELASTOGEAR_EIGEN_KERNELS
ELASTOGEAR_EIGEN_KERNELS(template struct)
#endif
