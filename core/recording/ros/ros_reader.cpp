#include "core/recording/ros/ros_reader.h"

#include "core/base/error.h"
#include "core/recording/ros/ros_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

// Range of the search for streams without messages so far.
constexpr std::uint64_t kMaxLooked_bytes = 64 << 20;
constexpr int kMaxLooked = 20'000;  // messages

}  // namespace

RosReader::RosReader(const std::filesystem::path& path) : path_(path.string()) {
  files_ = ros::rosFiles(path, sink(path));
  std::size_t readable = 0;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (!openFile(i)) continue;
    if (readable++ == 0) format_ = source_->format();
    for (std::size_t topic = 0; topic < streams_of_topics_.size(); ++topic)
      topics_.countMessages(streams_of_topics_[topic], source_->topics()[topic].messages);
    lookIntoFile();
  }
  if (readable == 0) throw badInput(path_, "none of its files can be read", topics_.faults().back().text);
  topics_.finishLooking();
  if (files_.size() > 1) source_.reset();
}

// A single file must be readable; one of several may be unreadable.
bool RosReader::openFile(std::size_t index) {
  file_ = index;
  source_.reset();
  streams_of_topics_.clear();
  try {
    source_ = ros::openRosFile(files_[index], sink(files_[index]));
  } catch (const CalibrationError& error) {
    if (files_.size() == 1 || error.kind() != ErrorKind::BadInput) throw;
    sink(files_[index])(FaultKind::Unreadable, error.what());
    return false;
  }
  matchTopics();
  return true;
}

void RosReader::matchTopics() {
  constexpr std::size_t kMaxTopics = 10'000;
  if (source_->topics().size() > kMaxTopics)
    throw badInput(
        files_[file_].string(),
        fmt::format("lists {} topics or connections, more than {}", source_->topics().size(), kMaxTopics),
        "Copy the recording again; if it is right, write its wanted topics into a new one");
  while (streams_of_topics_.size() < source_->topics().size())
    streams_of_topics_.push_back(topics_.add(source_->topics()[streams_of_topics_.size()].topic));
}

// Until all streams are known, but not through the entire file.
void RosReader::lookIntoFile() {
  const std::size_t faults = topics_.faults().size();
  const std::vector<ros::SourceTopic>& topics = source_->topics();
  const bool counted =
      std::any_of(topics.begin(), topics.end(), [](const ros::SourceTopic& t) { return t.messages > 0; });
  std::vector<bool> unknown(topics.size());
  for (std::size_t i = 0; i < topics.size(); ++i)
    unknown[i] = !topics_.knows(streams_of_topics_[i]) && (topics[i].messages > 0 || !counted);
  const auto anyUnknown = [&] { return std::find(unknown.begin(), unknown.end(), true) != unknown.end(); };
  std::uint64_t looked_bytes = 0;
  ros::SourceMessage message;
  source_->want(unknown);
  for (int i = 0; anyUnknown() && i < kMaxLooked && looked_bytes < kMaxLooked_bytes; ++i) {
    if (!source_->next(message)) break;
    if (message.topic >= unknown.size()) continue;
    const std::size_t stream = streams_of_topics_[message.topic];
    topics_.lookInto(stream, message.bytes);
    looked_bytes += message.bytes.size();
    if (!topics_.knows(stream)) continue;
    for (std::size_t k = 0; k < unknown.size(); ++k)
      if (streams_of_topics_[k] == stream) unknown[k] = false;
    if (source_->isIndexed()) source_->want(unknown);
  }
  topics_.dropFaultsFrom(faults);  // reading finds them again
  source_->rewind();
}

bool RosReader::nextFile() {
  std::size_t index = started_ ? file_ + 1 : 0;
  const bool is_open = !started_ && source_ != nullptr;
  started_ = true;
  if (!is_open) {
    const std::size_t faults = topics_.faults().size();  // found during the search
    while (index < files_.size() && !openFile(index)) ++index;
    topics_.dropFaultsFrom(faults);
    if (index >= files_.size()) return false;
  }
  std::vector<bool> wanted(streams_of_topics_.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = topics_.selected(streams_of_topics_[i]);
  source_->want(std::move(wanted));
  return true;
}

bool RosReader::read(Packet& packet) {
  if (topics_.handOutRest(packet)) return true;
  if (!started_) nextFile();
  ros::SourceMessage message;
  while (source_) {
    while (source_->next(message)) {
      const bool listed = message.topic < streams_of_topics_.size();
      const std::size_t stream = listed ? streams_of_topics_[message.topic] : ros::TopicStreams::kNone;
      if (!topics_.selected(stream)) continue;
      if (topics_.decode(stream, message.bytes, message.record_time_ns, source_->place(), packet))
        return true;
    }
    if (!nextFile()) source_.reset();
  }
  topics_.finishReading();
  packet.clear();
  return false;
}

// The index of such a file comes last.
bool RosReader::follow(const std::shared_ptr<Growth>& growth) {
  if (files_.size() != 1 || started_ || !source_->follow(growth)) return false;
  topics_.dropFaults(FaultKind::NoIndex);
  return true;
}

double RosReader::fractionRead() const {
  const double here = source_ ? source_->fractionRead() : started_ ? 1.0 : 0.0;
  return std::min(1.0, (static_cast<double>(file_) + here) / static_cast<double>(files_.size()));
}

ros::FaultSink RosReader::sink(const std::filesystem::path& file) {
  return [this, name = file.filename().string()](FaultKind kind, const std::string& text) {
    topics_.addFault("", kind, files_.size() > 1 ? name + ": " + text : text);
  };
}

}  // namespace evical
