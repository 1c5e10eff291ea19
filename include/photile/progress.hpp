// How long-running work reports its progress and is asked to stop.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace photile {

/// Receives the progress of one stage at a time. `advance` and `cancelled` may be called from any
/// thread. The base class ignores everything, so a library user may pass none.
class Progress {
 public:
  virtual ~Progress() = default;

  /// A stage starts. `total` counts `unit`s ("paths", "triangles", ...); 0 where it is not known.
  virtual void begin(std::string_view stage, std::uint64_t total, std::string_view unit);
  /// `count` more units are done.
  virtual void advance(std::uint64_t count);
  /// The stage is complete.
  virtual void end();
  /// A line for the user that is not progress: what was chosen, approximated or left out.
  virtual void note(const std::string& line);
  /// A warning about what may make the result wrong; it is printed even where notes are not. By
  /// default it is a note.
  virtual void warn(const std::string& line);
  /// True once the user asked to stop; stages then throw Interrupted at their next safe point.
  virtual bool cancelled() const;

  /// Throws Interrupted if the user asked to stop.
  void throw_if_cancelled() const;

  /// The one that ignores everything.
  static Progress& none();
};

/// Passes on only requests to stop: for the stages of one of many renderings, of which only the
/// number is reported.
class QuietProgress : public Progress {
 public:
  /// Keeps a reference.
  explicit QuietProgress(const Progress& outer) : outer_(outer) {}
  bool cancelled() const override { return outer_.cancelled(); }

 private:
  const Progress& outer_;
};

}  // namespace photile
