// A folder that is created for results, and removed if it stays empty.
#pragma once

#include "core/base/atomic_file.h"
#include "core/base/file_places.h"

#include <filesystem>
#include <system_error>

namespace evical {

class NewFolder {
 public:
  // Throws CalibrationError (BadInput) if it cannot be created or written to.
  explicit NewFolder(const std::filesystem::path& folder) : folder_(folder), was_there_(pathExists(folder)) {
    makeOutputFolder(folder);
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!was_there_) std::filesystem::remove(folder_, ignored);  // only if empty
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  bool wasThere() const { return was_there_; }

 private:
  std::filesystem::path folder_;
  bool was_there_;
};

}  // namespace evical
