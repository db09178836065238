#include "core/recording/pictures/picture_reader.h"

#include "core/base/file_places.h"
#include "core/format/picture_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace evical {
namespace {

constexpr std::uintmax_t kLargestPicture_bytes = std::uintmax_t{1} << 28;

// Size of the first existing picture.
Resolution firstPictureSize(const pictures::PictureList& list) {
  constexpr std::size_t kMaxTried = 10;
  constexpr std::uintmax_t kHead_bytes = 1 << 16;
  for (std::size_t i = 0; i < std::min(list.pictures.size(), kMaxTried); ++i) {
    const std::filesystem::path path = list.folder / list.pictures[i].name;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) continue;
    const Resolution size_px = pictureSize(contentOfFile(path, kHead_bytes));
    if (size_px.known()) return size_px;
  }
  return {};
}

}  // namespace

PictureReader::PictureReader(std::vector<pictures::PictureList> lists) {
  for (pictures::PictureList& list : lists) {
    StreamInfo stream;
    stream.name = list.name;
    stream.type = StreamType::Frames;
    stream.message = list.layout;
    stream.resolution_px = firstPictureSize(list);
    stream.messages = list.pictures.size();
    stream.timed = list.timed;
    streams_.push_back(std::move(stream));
    faults_.insert(faults_.end(), list.faults.begin(), list.faults.end());
    sources_.push_back({std::move(list)});
  }
}

void PictureReader::select(const std::vector<std::size_t>& streams) {
  for (Source& source : sources_) source.wanted = false;
  for (const std::size_t stream : streams) sources_.at(stream).wanted = true;
}

// The stream with the earliest time is read first, so that all cameras advance together.
bool PictureReader::read(Packet& packet) {
  for (;;) {
    packet.clear();
    Source* behind = nullptr;
    for (Source& source : sources_) {
      const auto time_ns = [](const Source& s) { return s.list.pictures[s.next].time_ns; };
      if (!source.finished() && (!behind || time_ns(source) < time_ns(*behind))) behind = &source;
    }
    if (!behind) return false;
    packet.stream = static_cast<std::size_t>(behind - sources_.data());
    Frame& frame = packet.frames.emplace_back();
    if (load(packet.stream, behind->list.pictures[behind->next++], frame)) return true;
  }
}

bool PictureReader::load(std::size_t stream, const pictures::Picture& picture, Frame& frame) {
  const std::filesystem::path path = sources_[stream].list.folder / picture.name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    addFault(stream, FaultKind::Unreadable, fmt::format("{} is missing; it is left out.", picture.name));
    return false;
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size == 0 || size > kLargestPicture_bytes) {
    addFault(stream, FaultKind::Corrupt,
             fmt::format("{} {}; it is left out.", picture.name,
                         error       ? "cannot be accessed"
                         : size == 0 ? "is empty"
                                     : fmt::format("has {} bytes, too many for a picture", size)));
    return false;
  }
  const std::string bytes = contentOfFile(path, size);
  if (pictureKind(bytes) == PictureKind::None) {
    addFault(stream, bytes.empty() ? FaultKind::Unreadable : FaultKind::Corrupt,
             fmt::format("{} {}; it is left out.", picture.name,
                         bytes.empty() ? "cannot be read" : "is not a JPEG, PNG, PNM, TIFF or BMP file"));
    return false;
  }
  frame.time_ns = picture.time_ns;
  frame.exposure_s = picture.exposure_s;
  frame.format = FrameFormat::Encoded;
  frame.bytes.assign(bytes.begin(), bytes.end());
  return true;
}

double PictureReader::fractionRead() const {
  std::size_t read = 0, all = 0;
  for (const Source& source : sources_) {
    if (!source.wanted) continue;
    read += source.next;
    all += source.list.pictures.size();
  }
  return all == 0 ? 1.0 : static_cast<double>(read) / static_cast<double>(all);
}

void PictureReader::addFault(std::size_t stream, FaultKind kind, std::string text) {
  const std::string& name = streams_[stream].name;
  const auto alike = [&](const RecordingFault& fault) { return fault.stream == name && fault.kind == kind; };
  if (std::count_if(faults_.begin(), faults_.end(), alike) < kMostAlikeFaults)
    faults_.push_back({name, kind, 0.0, std::move(text)});
}

}  // namespace evical
