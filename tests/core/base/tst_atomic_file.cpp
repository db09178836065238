#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "tests/support/file_content.h"
#include "tests/support/test_program.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QTemporaryDir>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace evical;

namespace {

std::ptrdiff_t entriesIn(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return std::distance(begin(entries), end(entries));
}

}  // namespace

class TestAtomicFile : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  std::filesystem::path folder() const { return scratch_.path().toStdString(); }

 private slots:
  void write_replacesWhole_leavesNothingElse() {
    const auto path = folder() / "a.yaml";
    const std::string large(3'000'000, 'x');
    writeFileWhole(path, large);
    QCOMPARE(evical::test::fileContent(path), QByteArray::fromStdString(large));
    writeFileWhole(path, "short");
    QCOMPARE(evical::test::fileContent(path), QByteArray("short"));
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(1));
    std::filesystem::remove(path);
  }

  void write_givesUsualPermissions() {
    const auto path = folder() / "b.yaml";
    const mode_t before = ::umask(022);
    writeFileWhole(path, "x");
    ::umask(before);
    struct stat status {};
    QCOMPARE(::stat(path.c_str(), &status), 0);
    QCOMPARE(status.st_mode & 0777u, 0644u);
    std::filesystem::remove(path);
  }

  void write_intoMissingFolder_namesPath() {
    const auto path = folder() / "missing" / "a.yaml";
    try {
      writeFileWhole(path, "x");
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY2(error.place().find("missing/a.yaml") != std::string::npos, error.what());
      QVERIFY2(error.problem().find("No such file") != std::string::npos, error.what());
    }
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(0));
  }

  void write_belowAFile_throws() {
    writeFileWhole(folder() / "file", "x");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, writeFileWhole(folder() / "file" / "a.yaml", "y"));
    QCOMPARE(evical::test::fileContent(folder() / "file"), QByteArray("x"));
    std::filesystem::remove(folder() / "file");
  }

  void write_overAFolder_leavesNothingBehind() {
    std::filesystem::create_directories(folder() / "d" / "inside");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, writeFileWhole(folder() / "d", "y"));
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(1));
    std::filesystem::remove_all(folder() / "d");
  }

  void writeSeveral_whereOneFails_changesNone() {
    writeFileWhole(folder() / "old", "before");
    const std::vector<FileContent> files{{folder() / "old", "after"}, {folder() / "missing" / "b", "x"}};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, writeFilesWhole(files));
    QCOMPARE(evical::test::fileContent(folder() / "old"), QByteArray("before"));
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(1));
    std::filesystem::remove(folder() / "old");
  }

  void write_overAPipe_leavesThePipe() {
    const auto pipe = folder() / "pipe";
    QCOMPARE(::mkfifo(pipe.c_str(), 0600), 0);
    QVERIFY_THROWS_EXCEPTION(CalibrationError, writeFileWhole(pipe, "x"));
    QVERIFY(std::filesystem::is_fifo(pipe));
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(1));
    std::filesystem::remove(pipe);
  }

  void moveSeveral_whereOneCannot_givesAllBack() {
    std::filesystem::create_directory(folder() / "from");
    std::vector<FileMove> moves;
    for (const std::string name : {"new", "old", "barred", "mark"}) {
      writeFileWhole(folder() / "from" / name, "after");
      moves.push_back({folder() / "from" / name, folder() / name});
    }
    for (const std::string name : {"old", "mark"}) writeFileWhole(folder() / name, "before");
    std::filesystem::create_directory(folder() / "barred");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, moveFilesWhole(moves));
    QCOMPARE(evical::test::fileContent(folder() / "old"), QByteArray("before"));
    QCOMPARE(evical::test::fileContent(folder() / "mark"), QByteArray("before"));
    QVERIFY(!std::filesystem::exists(folder() / "new"));
    QCOMPARE(entriesIn(folder() / "from"), std::ptrdiff_t(4));
    QCOMPARE(evical::test::fileContent(folder() / "from" / "old"), QByteArray("after"));
    std::filesystem::remove(folder() / "barred");
    moveFilesWhole(moves);
    for (const FileMove& move : moves) QCOMPARE(evical::test::fileContent(move.to), QByteArray("after"));
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(5));
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
      std::filesystem::remove_all(entry.path());
  }

  void moveOfAFolder_replacesTheOlderOneAsAWhole() {
    const auto from = folder() / "from", to = folder() / "to";
    for (const auto& each : {from / "frames", to / "frames"}) std::filesystem::create_directories(each);
    writeFileWhole(from / "frames" / "1.png", "after");
    writeFileWhole(to / "frames" / "1.png", "before");
    writeFileWhole(to / "frames" / "2.png", "before");
    const std::vector<FileMove> moves = {{from / "frames", to / "frames"}, {from / "mark", to / "mark"}};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, moveFilesWhole(moves));  // there is no mark
    QCOMPARE(evical::test::fileContent(to / "frames" / "1.png"), QByteArray("before"));
    QCOMPARE(entriesIn(to / "frames"), std::ptrdiff_t(2));
    writeFileWhole(from / "mark", "after");
    moveFilesWhole(moves);
    QCOMPARE(evical::test::fileContent(to / "frames" / "1.png"), QByteArray("after"));
    QCOMPARE(entriesIn(to / "frames"), std::ptrdiff_t(1));
    QCOMPARE(entriesIn(from), std::ptrdiff_t(0));
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
      std::filesystem::remove_all(entry.path());
  }

  // Runs in another process that is killed at any time: if the mark exists, all files must be of its run.
  void killedRun_leavesNoPartsOfTwo() {
    constexpr int kFiles = 20, kKills = 60;
    const auto nameOf = [&](int file) { return folder() / (file == kFiles ? "mark" : std::to_string(file)); };
    int marked = 0;
    for (int kill = 0; kill < kKills; ++kill) {
      const pid_t child = ::fork();
      if (child == 0) {
        std::filesystem::create_directory(folder() / "from");
        for (int run = 100 * kill;; ++run) {
          std::vector<FileMove> moves;
          for (int file = 0; file <= kFiles; ++file) {
            moves.push_back({folder() / "from" / std::to_string(file), nameOf(file)});
            std::ofstream(moves.back().from) << run;
          }
          moveFilesWhole(moves);
        }
      }
      const int longer_us = marked == 0 ? 1000 * kill : 0;  // a busy machine needs longer for the first mark
      ::usleep(static_cast<useconds_t>(5000 + 731 * kill % 4000 + longer_us));
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
      if (!std::filesystem::exists(folder() / "mark")) continue;
      ++marked;
      for (int file = 0; file < kFiles; ++file)
        QCOMPARE(evical::test::fileContent(nameOf(file)), evical::test::fileContent(folder() / "mark"));
    }
    QVERIFY(marked > 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
      std::filesystem::remove_all(entry.path());
  }

  void litter_ofKilledRuns_isRemovedAfterAnHour() {
    const auto old = folder() / "a.yaml.part.Ab0cdE", young = folder() / "a.yaml.part.Xy1zAb",
               other = folder() / "a.yaml.part.important", staged = folder() / "a.yaml.part.AAAAAA";
    for (const auto& file : {old, young, other}) std::ofstream(file) << "x";
    std::filesystem::create_directory(staged);
    std::ofstream(staged / "inside") << "x";
    const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(2);
    for (const auto& file : {old, other, staged / "inside", staged})
      std::filesystem::last_write_time(file, long_ago);
    writeFileWhole(folder() / "a.yaml", "x");
    QVERIFY(!std::filesystem::exists(old) && !std::filesystem::exists(staged));
    QVERIFY(std::filesystem::exists(young) && std::filesystem::exists(other));
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
      std::filesystem::remove_all(entry.path());
  }

  // After a kill exactly between the renames.
  void fileThatWasBeingReplaced_isNamed_andStaysUntilThereIsANewOne() {
    const auto file = folder() / "result.yaml", former = folder() / "result.yaml.former.Ab0cdE";
    std::ofstream(former) << "status: ok\n";
    std::filesystem::last_write_time(former,
                                     std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    try {
      YamlNode::load(file);
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY2(
          std::string(error.what()).find("stopped while it replaced the file. 'result.yaml.former.Ab0cdE'") !=
              std::string::npos,
          error.what());
    }
    removeLitterOf(file);
    QVERIFY(std::filesystem::exists(former));
    std::ofstream(file) << "status: ok\n";
    removeLitterOf(file);
    QVERIFY(!std::filesystem::exists(former));
    std::filesystem::remove(file);
  }

  void folderWithin_replacesLinks() {
    const auto elsewhere = folder() / "elsewhere", output = folder() / "output";
    std::filesystem::create_directories(elsewhere);
    std::filesystem::create_directory_symlink(elsewhere, output);  // chosen by the user
    std::filesystem::create_directory_symlink(folder(), elsewhere / "below");
    makeFolderWithin(output, "below/deeper");
    QVERIFY(std::filesystem::is_symlink(output) && !std::filesystem::is_symlink(output / "below"));
    QVERIFY(std::filesystem::is_directory(elsewhere / "below" / "deeper"));
    QVERIFY(!std::filesystem::exists(folder() / "deeper"));
    for (const auto& path : {output, elsewhere}) std::filesystem::remove_all(path);
  }

  void outputFolder_isMade_butNotBelowAFile() {
    makeOutputFolder(folder() / "x" / "y");
    QVERIFY(std::filesystem::is_directory(folder() / "x" / "y"));
    writeFileWhole(folder() / "file", "x");
    try {
      makeOutputFolder(folder() / "file" / "y");
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
    }
  }
};

EVICAL_TEST(TestAtomicFile)
#include "tst_atomic_file.moc"
