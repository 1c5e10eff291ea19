// Progress of work within work.
#pragma once

#include "photile/progress.hpp"

namespace photile {

/// Passes the wish to stop on, and nothing else: for the stages of one of many renderings, of which
/// only their number is worth telling.
class QuietProgress : public Progress {
 public:
  /// Keeps a reference.
  explicit QuietProgress(const Progress& outer) : outer_(outer) {}
  bool cancelled() const override { return outer_.cancelled(); }

 private:
  const Progress& outer_;
};

}  // namespace photile
