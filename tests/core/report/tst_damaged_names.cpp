// Assessments as YAML and JSON. Names need not be UTF-8: files and topics may have any bytes, and reports
// must be written nevertheless.
#include "core/base/yaml_node.h"
#include "core/report/assessment_report.h"
#include "tests/support/test_program.h"

#include <QJsonDocument>
#include <QJsonObject>

#include <limits>

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
    isJsonWithNote(maintenance);
  }
  void check_isJsonAllTheSame() {
    CalibrationCheck check;
    check.inputs = {kLatin1};
    check.windows.emplace_back().sensor = kLatin1;
    check.without_board = true;
    isJsonWithNote(check);
  }
  void repeat_isJsonAllTheSame() {
    Repeatability repeat;
    repeat.recordings.emplace_back().file = kLatin1;
    repeat.columns = {kLatin1};
    isJsonWithNote(repeat);
  }

  // Both are generated from one description.
  void yaml_hasTheKeysOfJson() {
    Maintenance maintenance;
    maintenance.reason = "it's: so";
    Finding& finding = maintenance.findings.emplace_back();
    finding.sensor = "rear";
    finding.quantity = "rotation";
    finding.smallest_detectable_change = std::numeric_limits<double>::infinity();
    finding.alternatives = {"lever arm", "time offset"};
    finding.numbers = {{"rotation.x", "deg", {0.1 + 0.2, 0.123456789}}};
    MaintenanceStep& step = maintenance.steps.emplace_back();
    step.at_s = 12345.678;
    const YamlNode yaml = YamlNode::parse(assessmentYaml(maintenance), "maintenance.yaml");
    const auto json =
        QJsonDocument::fromJson(QByteArray::fromStdString(assessmentJson(maintenance))).object();
    QCOMPARE(static_cast<int>(yaml.keys().size()), json.size());
    for (const std::string& key : yaml.keys())
      QVERIFY2(json.contains(QString::fromStdString(key)), key.c_str());
    QCOMPARE(yaml["reason"].text(), maintenance.reason);
    const YamlNode found = yaml["findings"].items().at(0);
    QCOMPARE(found["alternatives"].items().size(), std::size_t{2});
    QCOMPARE(found["smallest_detectable_change"].text(), std::string(".inf"));
    const YamlNode number = found["numbers"].items().at(0);
    QCOMPARE(number["before"].real(), 0.1 + 0.2);
    QCOMPARE(number["before_std"].real(), 0.123457);
    QVERIFY(!number.has("now") && !number.has("joint"));
    QCOMPARE(yaml["steps"].items().at(0)["at_s"].real(), 12345.678);
  }

 private:
  template <class Family>
  static void isJsonWithNote(Family family) {
    family.notes = {kLatin1 + ": a note"};
    const std::string text = assessmentJson(family);
    QVERIFY(isJson(text));
    QVERIFY(text.find("g.csv: a note") != std::string::npos);
  }
};

EVICAL_TEST(TestDamagedNames)
#include "tst_damaged_names.moc"
