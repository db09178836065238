#include "core/base/error.h"
#include "core/base/files_together.h"
#include "tests/support/file_content.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace evical;

class TestFilesTogether : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  std::filesystem::path folder() const { return scratch_.path().toStdString(); }

 private slots:
  void files_takeTheirPlacesTogether() {
    const auto place = folder() / "result";
    FilesTogether files;
    files.makeFolder(place / "plots");
    files.write({place / "plots" / "a.csv", "1"});
    files.write({place / "result.yaml", "2"});
    QVERIFY(!std::filesystem::exists(place / "plots" / "a.csv"));
    QVERIFY(!std::filesystem::exists(place / "result.yaml"));
    files.place();
    QCOMPARE(evical::test::fileContent(place / "plots" / "a.csv"), QByteArray("1"));
    QCOMPARE(evical::test::fileContent(place / "result.yaml"), QByteArray("2"));
  }

  void files_thatWereNotPlaced_leaveNeitherThemselvesNorFolders() {
    const auto place = folder() / "unfinished";
    {
      FilesTogether files;
      files.makeFolder(place / "plots");
      files.write({place / "plots" / "a.csv", "1"});
      QVERIFY(std::filesystem::exists(place / "plots"));
    }
    QVERIFY(!std::filesystem::exists(place));
  }

  // A result folder of a stranger.
  void linksToFolders_areReplaced_butRestoredIfNothingIsPlaced() {
    const auto place = folder() / "strange", elsewhere = folder() / "elsewhere";
    std::filesystem::create_directories(place);
    std::filesystem::create_directories(elsewhere);
    writeFileWhole(elsewhere / "a.csv", "theirs");
    std::filesystem::create_directory_symlink(elsewhere, place / "plots");
    {
      FilesTogether files;
      files.writeInto(place, {"plots/a.csv", "1"});
    }
    QVERIFY(std::filesystem::is_symlink(place / "plots"));
    FilesTogether files;
    files.writeInto(place, {"plots/a.csv", "2"});
    files.place();
    QVERIFY(!std::filesystem::is_symlink(place / "plots"));
    QCOMPARE(evical::test::fileContent(place / "plots" / "a.csv"), QByteArray("2"));
    QCOMPARE(evical::test::fileContent(elsewhere / "a.csv"), QByteArray("theirs"));
  }

  void folders_thatWereThere_stayWithWhatIsInThem() {
    const auto place = folder() / "old";
    std::filesystem::create_directories(place);
    writeFileWhole(place / "kept.yaml", "old");
    {
      FilesTogether files;
      files.makeFolder(place);
      files.write({place / "kept.yaml", "new"});
      // A folder has the name of a required file: then the files written before are not placed either.
      std::filesystem::create_directories(place / "folder");
      QVERIFY_THROWS_EXCEPTION(CalibrationError, files.write({place / "folder", "x"}));
    }
    QCOMPARE(evical::test::fileContent(place / "kept.yaml"), QByteArray("old"));
    const std::filesystem::directory_iterator entries(place);
    QCOMPARE(std::distance(begin(entries), end(entries)), std::ptrdiff_t(2));
  }
};

EVICAL_TEST(TestFilesTogether)
#include "tst_files_together.moc"
