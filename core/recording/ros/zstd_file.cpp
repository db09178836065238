#include "core/recording/ros/zstd_file.h"

#include "core/base/error.h"
#include "core/recording/unpacking_limit.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <vector>

namespace evical::ros {
namespace {

struct ClosingFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, ClosingFile>;

File temporaryFile(std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error)
    throw badInput(
        folder.empty() ? "TMPDIR" : folder.string(),
        fmt::format("the temporary folder, into which a packed recording is unpacked, cannot be used: {}",
                    error.message()),
        "Set TMPDIR to an existing folder");
  std::string name = (folder / "evical_XXXXXX").string() + kUnpackedEnding;
  const int descriptor = mkstemps(name.data(), static_cast<int>(std::string_view(kUnpackedEnding).size()));
  path = name;
  return File(descriptor >= 0 ? fdopen(descriptor, "wb") : nullptr);
}

[[noreturn]] void failWriting(const std::filesystem::path& path) {
  throw calibrationFailed(path.string(), "the recording cannot be unpacked into the temporary folder",
                          "Free disk space, or set TMPDIR to another folder");
}

// Returns the number of intact bytes of the input.
std::uint64_t unpack(std::istream& input, const File& output, const std::filesystem::path& target,
                     UnpackingLimit limit, bool& whole) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  std::vector<char> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::uint64_t good = 0;
  whole = true;
  for (;;) {
    input.read(packed.data(), static_cast<std::streamsize>(packed.size()));
    ZSTD_inBuffer in{packed.data(), static_cast<std::size_t>(input.gcount()), 0};
    if (in.size == 0) return good;
    for (bool full = false; in.pos < in.size || full;) {
      ZSTD_outBuffer out{plain.data(), plain.size(), 0};
      const std::size_t hint = ZSTD_decompressStream(context.get(), &out, &in);
      whole = hint == 0;
      if (ZSTD_isError(hint) != 0U) return good + in.pos;
      limit.add(out.pos);
      if (std::fwrite(plain.data(), 1, out.pos, output.get()) != out.pos) failWriting(target);
      full = out.pos == out.size && !whole;
    }
    good += in.size;
  }
}

}  // namespace

UnpackedZstdFile::UnpackedZstdFile(const std::filesystem::path& path, const FaultSink& sink) {
  std::ifstream input(path, std::ios::binary);
  if (!input) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  const File output = temporaryFile(path_);
  if (!output) failWriting(path_);
  try {
    bool whole = false;
    const std::uint64_t good =
        unpack(input, output, path_, {path.string(), std::filesystem::file_size(path)}, whole);
    if (!whole) {
      sink(FaultKind::Truncated,
           fmt::format("The packed file {} is cut off or damaged at byte {}; the part before is read.",
                       path.filename().string(), good));
    }
    if (std::fflush(output.get()) != 0) failWriting(path_);
  } catch (...) {
    std::remove(path_.c_str());
    throw;
  }
}

UnpackedZstdFile::~UnpackedZstdFile() {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace evical::ros
