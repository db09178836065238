// Live streams as recordings. What arrives is written into a temporary file at once, and read from there, so
// that a slow reader loses nothing.
#pragma once

#include "core/recording/recording_reader.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

namespace evical {

// "-" for the standard input, an address of a server, or a file that is still being written.
bool isLiveAddress(std::string_view source);

// For people: "the standard input", or the address.
std::string liveName(const std::string& source);

// Longest silence of servers; tests have less time.
struct LivePatience {
  static inline std::chrono::milliseconds first_bytes{10'000};
  static inline std::chrono::milliseconds again{3'000};  // to answer after a connection broke
};

// Waits for the first data and opens them. `folder`: for the temporary file, which has no name and disappears
// with the program. A stop ends the stream, not the reader: it still returns everything that has arrived.
// Throws CalibrationError (BadInput), and Cancelled if it is stopped before there are data.
[[nodiscard]] std::unique_ptr<RecordingReader> openLive(const std::string& source,
                                                        const std::filesystem::path& folder,
                                                        std::stop_token stop);

}  // namespace evical
