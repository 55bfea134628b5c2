#pragma once
// Verbs that run inside another program report to it instead of to a terminal.

#include <functional>
#include <string>
#include <string_view>

namespace elastogear::app {

struct Embedding {
  std::function<void(const std::string& name, const std::string& text)> item;  ///< of the summary
  std::function<void(std::string_view stage, double fraction)> progress;       ///< may throw to end the work
  std::function<bool()> interrupted;                                           ///< shall the run stop?
};

/// The one in force; nullptr where the verbs are a program of their own.
const Embedding* embedding();

/// Puts an embedding in force while it lives, which it must outlive.
class EmbeddingScope {
 public:
  explicit EmbeddingScope(const Embedding& embedding);
  ~EmbeddingScope();
  EmbeddingScope(const EmbeddingScope&) = delete;
  EmbeddingScope& operator=(const EmbeddingScope&) = delete;

 private:
  const Embedding* before_;
};

}  // namespace elastogear::app
