#include "app/console/embedding.h"

#include <utility>

namespace elastogear::app {
namespace {

const Embedding* present = nullptr;

}  // namespace

const Embedding* embedding() { return present; }

EmbeddingScope::EmbeddingScope(const Embedding& embedding) : before_(std::exchange(present, &embedding)) {}
EmbeddingScope::~EmbeddingScope() { present = before_; }

}  // namespace elastogear::app
