#include "core/recording/ros/sqlite_source.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/recording/ros/compression.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <utility>

namespace evical::ros {
namespace {

// Path in a URI, with escaped special characters.
std::string uriOf(const std::filesystem::path& path, bool immutable) {
  std::string uri = "file:";
  for (const char character : std::filesystem::absolute(path).string()) {
    if (character == '%' || character == '?' || character == '#') {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(character));
    } else {
      uri += character;
    }
  }
  return uri + (immutable ? "?mode=ro&immutable=1" : "?mode=ro");
}

// A recorder is still writing, or crashed: the newest messages are not yet in the file itself.
bool hasWriteAheadLog(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path.string() + "-wal", error);
  return !error && size > 0;
}

// With its write-ahead log.
std::uint64_t bytesOnDisk(const std::filesystem::path& path) {
  const auto bytesOf = [](const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    return error ? 0 : bytes;
  };
  return bytesOf(path) + bytesOf(path.string() + "-wal");
}

// Size stated by the file's header; 0 without header.
std::uint64_t statedBytes(const std::filesystem::path& path) {
  std::array<unsigned char, 32> header{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(header.data()), header.size());
  if (file.gcount() != static_cast<std::streamsize>(header.size())) return 0;
  const std::uint64_t page = header[16] * 256U + header[17];
  const std::uint64_t pages =
      (std::uint64_t{header[28]} << 24) + header[29] * 65536U + header[30] * 256U + header[31];
  return (page == 1 ? 65536 : page) * pages;
}

constexpr std::int64_t kLargestId = std::int64_t{1} << 40;

// Limits of the lists of topics and definitions: a column's default value makes rows long that take no space
// in the file.
class ListedText {
 public:
  explicit ListedText(std::string file) : file_(std::move(file)) {}

  // Throws CalibrationError (BadInput).
  void add(std::size_t bytes) {
    constexpr std::uint64_t kMax_bytes = std::uint64_t{1} << 26, kMaxRows = 10'000;
    bytes_ += bytes;
    if (++rows_ <= kMaxRows && bytes_ <= kMax_bytes) return;
    throw badInput(
        file_,
        fmt::format("lists more than {} topics or message types, or more than {} MB of their texts", kMaxRows,
                    kMax_bytes >> 20),
        "Copy the recording again; if it is right, write its wanted topics into a new one");
  }

 private:
  std::string file_;
  std::uint64_t bytes_ = 0, rows_ = 0;
};

}  // namespace

class SqliteSource::Database {
 public:
  Database(const std::filesystem::path& path, bool immutable, bool cut) {
    const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX;
    status_ = sqlite3_open_v2(uriOf(path, immutable).c_str(), &handle_, flags, nullptr);
    if (!ok()) return;
    // No value is longer than the file, unless it is computed.
    constexpr std::uint64_t kMin_bytes = 1 << 20, kMax_bytes = 1'000'000'000;
    sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH,
                  static_cast<int>(std::clamp(bytesOnDisk(path), kMin_bytes, kMax_bytes)));
    // Code in a file of unknown origin must not run.
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, cut ? 0 : 1, nullptr);
    // Files that are shorter than stated are only accepted in this mode.
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_WRITABLE_SCHEMA, cut ? 1 : 0, nullptr);
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    status_ = sqlite3_exec(handle_, "PRAGMA cell_size_check=ON; SELECT 1 FROM sqlite_master", nullptr,
                           nullptr, nullptr);
  }
  ~Database() { sqlite3_close(handle_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  bool ok() const { return status_ == SQLITE_OK; }
  sqlite3* handle() const { return handle_; }
  std::string problem() const { return handle_ != nullptr ? sqlite3_errmsg(handle_) : "out of memory"; }

 private:
  sqlite3* handle_ = nullptr;
  int status_ = SQLITE_OK;
};

class SqliteSource::Statement {
 public:
  Statement(const Database& database, const std::string& sql) {
    status_ =
        sqlite3_prepare_v2(database.handle(), sql.c_str(), static_cast<int>(sql.size()), &handle_, nullptr);
  }
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  // True on a row; ok() stays true at the end.
  bool step() {
    if (handle_ == nullptr) return false;
    status_ = sqlite3_step(handle_);
    return status_ == SQLITE_ROW;
  }
  bool ok() const { return status_ == SQLITE_OK || status_ == SQLITE_ROW || status_ == SQLITE_DONE; }
  std::int64_t integer(int column) const { return sqlite3_column_int64(handle_, column); }
  std::string_view bytes(int column) const {
    const void* data = sqlite3_column_blob(handle_, column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_, column));
    return data != nullptr ? std::string_view(static_cast<const char*>(data), size) : std::string_view();
  }
  std::string text(int column) const { return std::string(bytes(column)); }

 private:
  sqlite3_stmt* handle_ = nullptr;
  int status_ = SQLITE_OK;
};

SqliteSource::SqliteSource(const std::filesystem::path& path, FaultSink sink)
    : path_(path), sink_(std::move(sink)), limit_(path.string(), bytesOnDisk(path)) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const std::uint64_t stated = statedBytes(path);
  cut_ = !error && size < stated;
  if (cut_) sink_(FaultKind::Truncated, fmt::format("The file ends at byte {} of {}.", size, stated));
  open();
  listTopics();
  countMessages();
}

SqliteSource::~SqliteSource() = default;

void SqliteSource::open() {
  const bool has_log = hasWriteAheadLog(path_);
  if (has_log) database_ = std::make_unique<Database>(path_, false, cut_);
  if (has_log && !database_->ok()) {
    sink_(FaultKind::Truncated,
          "The newest messages are in the file's write-ahead log, which cannot be read here; they are left "
          "out.");
  }
  if (!has_log || !database_->ok()) database_ = std::make_unique<Database>(path_, true, cut_);
  if (database_->ok() && hasTable("topics") && hasTable("messages")) {
    for (const char* const table : {"topics", "messages", "message_definitions"}) refuseComputed(table);
    return;
  }
  if (!database_->ok()) {
    throw badInput(path_.string(),
                   fmt::format("the SQLite file of {} bytes cannot be read: {}",
                               std::filesystem::file_size(path_), database_->problem()),
                   "Copy it again; try `sqlite3 FILE .recover`");
  }
  throw badInput(path_.string(), "this SQLite file is not a ROS 2 bag: it has no tables topics and messages");
}

bool SqliteSource::hasTable(const char* name) {
  Statement statement(*database_,
                      fmt::format("SELECT 1 FROM sqlite_master WHERE type='table' AND name='{}'", name));
  return statement.step();
}

// Generated columns and virtual tables run the file's own expressions, for any time and with any result.
void SqliteSource::refuseComputed(const char* table) {
  Statement columns(*database_,
                    fmt::format("SELECT 1 FROM pragma_table_xinfo('{}') WHERE hidden <> 0", table));
  Statement virtuals(*database_, fmt::format("SELECT 1 FROM sqlite_master WHERE name='{}' AND "
                                             "sql NOT LIKE 'CREATE TABLE%'",
                                             table));
  if (columns.step() || virtuals.step())
    throw badInput(path_.string(),
                   fmt::format("its table {} computes its values, which no recorder does", table),
                   "Record again, or copy the rows into a plain table");
}

bool SqliteSource::hasTimeIndex() {
  Statement statement(*database_,
                      "SELECT 1 FROM sqlite_master WHERE type='index' AND tbl_name='messages' AND sql LIKE "
                      "'%(timestamp%'");
  return statement.step();
}

void SqliteSource::listTopics() {
  const std::map<std::string, std::string> known = definitions();
  Statement statement(*database_, "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  ListedText listed(path_.string());
  while (statement.step()) {
    SourceTopic entry;
    entry.topic = {statement.text(1), statement.text(2), "", "", Serialization::Cdr};
    listed.add(entry.topic.name.size() + entry.topic.type.size());
    if (const auto found = known.find(entry.topic.type); found != known.end())
      entry.topic.definition = found->second;
    if (const std::string format = statement.text(3); format != "cdr") {
      entry.topic.type += fmt::format(" ({})", format);  // unknown type
      entry.topic.definition.clear();
    }
    if (statement.text(1).empty() || statement.text(2).empty()) {
      sink_(FaultKind::Corrupt,
            fmt::format("The table of topics is damaged: the entry with id {} has no name or no type.",
                        statement.integer(0)));
    }
    topic_of_id_[statement.integer(0)] = topics_.size();
    topics_.push_back(std::move(entry));
  }
  if (statement.ok()) return;
  throw badInput(path_.string(), fmt::format("the table of topics cannot be read: {}", database_->problem()));
}

// Only newer bags have message definitions.
std::map<std::string, std::string> SqliteSource::definitions() {
  std::map<std::string, std::string> found;
  if (!hasTable("message_definitions")) return found;
  Statement statement(*database_,
                      "SELECT topic_type, encoded_message_definition FROM message_definitions "
                      "WHERE encoding='ros2msg'");
  ListedText listed(path_.string());
  while (statement.step()) {
    std::string definition = statement.text(1);
    listed.add(definition.size());
    found[statement.text(0)] = std::move(definition);
  }
  return found;
}

void SqliteSource::countMessages() {
  Statement statement(*database_, "SELECT topic_id, COUNT(*), MAX(id) FROM messages GROUP BY topic_id");
  while (statement.step()) {
    const auto found = topic_of_id_.find(statement.integer(0));
    largest_id_ = std::max(largest_id_, statement.integer(2));
    if (found == topic_of_id_.end()) {
      sink_(FaultKind::Corrupt,
            fmt::format("{} of a topic with id {}, which the file does not list; left out.",
                        counted(static_cast<std::uint64_t>(statement.integer(1)), "message", "is", "are"),
                        statement.integer(0)));
      continue;
    }
    topics_[found->second].messages = static_cast<std::uint64_t>(statement.integer(1));
    count_ += topics_[found->second].messages;
  }
  last_whole_id_ = largest_id_;
  if (statement.ok()) return;
  Statement walk(*database_, "SELECT id FROM messages ORDER BY id");
  while (walk.step()) last_whole_id_ = walk.integer(0);
  for (SourceTopic& topic : topics_) topic.messages = 0;
  count_ = 0;
  Statement last(*database_, "SELECT MAX(id) FROM messages");
  // Without the last pages the largest id is unknown: then the search ends with the doubled steps.
  largest_id_ = last.step() ? last.integer(0) : kLargestId;
}

void SqliteSource::rewind() {
  limit_.restart();
  messages_.reset();
  last_id_ = from_id_ = 0;
  skip_ids_ = 1;
  read_ = 0;
  by_time_ = true;
}

std::string SqliteSource::place() const {
  return fmt::format("with id {}", last_id_);
}

double SqliteSource::fractionRead() const {
  return count_ == 0 ? 0.0 : std::min(1.0, static_cast<double>(read_) / static_cast<double>(count_));
}

void SqliteSource::query() {
  std::string ids;
  for (const auto& [id, topic] : topic_of_id_) {
    if (topic < wanted_.size() && !wanted_[topic]) continue;
    if (!ids.empty()) ids += ',';
    ids += std::to_string(id);
  }
  messages_ = std::make_unique<Statement>(
      *database_, fmt::format("SELECT id, topic_id, timestamp, data FROM messages WHERE topic_id IN ({}) AND "
                              "id > {} ORDER BY {}",
                              ids, from_id_, by_time_ ? "timestamp" : "id"));
}

bool SqliteSource::next(SourceMessage& message) {
  if (!messages_) {
    by_time_ = by_time_ && hasTimeIndex();
    query();
  }
  while (step())
    if (handOut(message)) return true;
  return false;
}

bool SqliteSource::step() {
  if (messages_->step()) return true;
  return !messages_->ok() && readOnBehindDamage(database_->problem());
}

// In order of storage from the last message on, skipping unreadable parts. A misplaced page ends
// each query at the same point, with messages that were read before: each query begins
// after the begin of the last one.
bool SqliteSource::readOnBehindDamage(const std::string& reason) {
  sink_(FaultKind::Corrupt,
        fmt::format("The file is damaged after message {} ({}); readable messages after it are read.",
                    last_id_, reason));
  if (last_id_ > from_id_ || (by_time_ && last_id_ == 0)) skip_ids_ = 0;
  by_time_ = false;
  from_id_ = std::max(from_id_, last_id_);
  for (;;) {
    if (from_id_ > largest_id_ || skip_ids_ > largest_id_ - from_id_) return false;
    from_id_ += skip_ids_;
    skip_ids_ = std::max<std::int64_t>(1, 2 * skip_ids_);
    query();
    if (messages_->step()) return true;
    if (messages_->ok()) return false;
  }
}

// The library reads zeros in place of missing pages, which are those of the last messages.
bool SqliteSource::isCutOff(std::int64_t id, std::string_view bytes) const {
  constexpr std::int64_t kLast = 16;
  constexpr std::size_t kZeros = 80;  // IMU messages end with up to 72
  return id > last_whole_id_ - kLast && bytes.size() > kZeros &&
         bytes.substr(bytes.size() - kZeros).find_first_not_of('\0') == std::string_view::npos;
}

bool SqliteSource::handOut(SourceMessage& message) {
  const std::int64_t id = messages_->integer(0);
  if (!by_time_ && id <= last_id_) {
    sink_(FaultKind::Corrupt,
          fmt::format("The message with id {} is after the one with id {}; it is left out.", id, last_id_));
    return false;
  }
  ++read_;
  last_id_ = std::max(last_id_, id);
  std::string_view bytes = messages_->bytes(3);
  if (cut_ && isCutOff(id, bytes)) {
    sink_(FaultKind::Truncated,
          fmt::format("The message {} ends in the missing part of the file; it is left out.", place()));
    return false;
  }
  if (bytes.starts_with(kZstdMagic)) {
    const Unpacked result = unpackZstdFrame(bytes, unpacked_);
    limit_.add(unpacked_.size());
    if (result != Unpacked::Whole) {
      sink_(FaultKind::Corrupt, fmt::format("The message {} cannot be unpacked; it is left out.", place()));
      return false;
    }
    bytes = unpacked_;
  } else {
    limit_.add(bytes.size());
  }
  message = {topic_of_id_.at(messages_->integer(1)), messages_->integer(2), bytes};
  return true;
}

}  // namespace evical::ros
