// A file that is still being written. Readers that follow it wait at its end for more
// (RecordingReader::follow).
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

namespace evical {

class Growth {
 public:
  // How the end is known: the writer calls end(), or another program's file does not grow for a while.
  enum class EndsBy { Writer, Silence };
  static constexpr double kSilence_s = 5.0;

  Growth(std::filesystem::path path, EndsBy ends_by) : path_(std::move(path)), ends_by_(ends_by) {}

  // Size of the file, in bytes: after a wait until it has at least `bytes`, or has ended, or this thread
  // should stop (StopWaiting). From several threads.
  std::uint64_t waitFor(std::uint64_t bytes);
  // Size now.
  std::uint64_t bytes() const;

  void end() { ended_ = true; }
  bool hasEnded() const { return ended_; }
  // A reader has used everything, and there is nothing yet.
  bool isAwaited() const { return waiting_ > 0; }

 private:
  std::filesystem::path path_;
  EndsBy ends_by_;
  std::atomic<bool> ended_ = false;
  std::atomic<int> waiting_ = 0;
};

// Longest part of a file that is waited for: a size that was read from damaged bytes may be any.
inline constexpr std::uint64_t kLargestAwaited_bytes = std::uint64_t{1} << 30;

}  // namespace evical
