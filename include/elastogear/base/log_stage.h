#pragma once
// Stages of PETSc's log, by which -log_view tells where the time goes.

namespace elastogear {

/// A stage of PETSc's log for as long as it lives; those of one name are one stage. Stages that begin within
/// another one interrupt it. Before PETSc is started it does nothing.
class LogStage {
 public:
  explicit LogStage(const char* name);
  ~LogStage();
  LogStage(const LogStage&) = delete;
  LogStage& operator=(const LogStage&) = delete;

 private:
  bool pushed_ = false;
};

}  // namespace elastogear
