#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "tests/support/test_program.h"

#include <sys/stat.h>

#include <QTemporaryDir>

#include <algorithm>
#include <fstream>
#include <iterator>

using namespace evical;

namespace {

std::string contentOf(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

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
    QCOMPARE(contentOf(path), large);
    writeFileWhole(path, "short");
    QCOMPARE(contentOf(path), std::string("short"));
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
    QVERIFY_EXCEPTION_THROWN(writeFileWhole(folder() / "file" / "a.yaml", "y"), CalibrationError);
    QCOMPARE(contentOf(folder() / "file"), std::string("x"));
    std::filesystem::remove(folder() / "file");
  }

  void write_overAFolder_leavesNothingBehind() {
    std::filesystem::create_directories(folder() / "d" / "inside");
    QVERIFY_EXCEPTION_THROWN(writeFileWhole(folder() / "d", "y"), CalibrationError);
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(1));
    std::filesystem::remove_all(folder() / "d");
  }

  void writeSeveral_whereOneFails_changesNone() {
    writeFileWhole(folder() / "old", "before");
    const std::vector<FileContent> files{{folder() / "old", "after"}, {folder() / "missing" / "b", "x"}};
    QVERIFY_EXCEPTION_THROWN(writeFilesWhole(files), CalibrationError);
    QCOMPARE(contentOf(folder() / "old"), std::string("before"));
    QCOMPARE(entriesIn(folder()), std::ptrdiff_t(1));
    std::filesystem::remove(folder() / "old");
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
