#include "elastogear/base/log_stage.h"

#include "elastogear/base/petsc.h"

namespace elastogear {

LogStage::LogStage(const char* name) {
  PetscBool started = PETSC_FALSE;
  PetscLogStage stage = -1;
  check(PetscInitialized(&started));
  if (!started) return;
  check(PetscLogStageGetId(name, &stage));
  if (stage < 0) check(PetscLogStageRegister(name, &stage));
  check(PetscLogStagePush(stage));
  pushed_ = true;
}

LogStage::~LogStage() {
  if (pushed_) PetscLogStagePop();
}

}  // namespace elastogear
