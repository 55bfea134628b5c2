#include <cstdio>

#include "elastogear/base/petsc.h"
#include "elastogear/base/version.h"

int main(int argc, char** argv) {
  elastogear::Session session(argc, argv);
  std::printf("elastogear %s (%s)\n", elastogear::version(), elastogear::git_hash());
}
