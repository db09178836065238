// Names that are not UTF-8: files and topics have any bytes, and reports are written all the same.
#include "core/report/maintenance_report.h"
#include "tests/support/test_program.h"

#include <QJsonDocument>

using namespace evical;

namespace {

const std::string kLatin1 = "l\xf6g.csv";

bool isJson(const std::string& text) {
  return !QJsonDocument::fromJson(QByteArray::fromStdString(text)).isNull();
}

}  // namespace

class TestDamagedNames : public QObject {
  Q_OBJECT

 private slots:
  void maintenance_isJsonAllTheSame() {
    Maintenance maintenance;
    MaintainedImu& imu = maintenance.imus.emplace_back();
    imu.name = kLatin1;
    imu.stream = kLatin1;
    maintenance.notes = {kLatin1 + ": a note"};
    const std::string text = maintenanceJson(maintenance);
    QVERIFY(isJson(text));
    QVERIFY(text.find("g.csv: a note") != std::string::npos);
  }
};

EVICAL_TEST(TestDamagedNames)
#include "tst_damaged_names.moc"
