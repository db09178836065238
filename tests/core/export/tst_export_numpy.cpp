// NumPy's own rules: lib/format.py of NumPy 1.24.2 (Debian's python3-numpy) for arrays, Python's zipfile for
// the archive.
#include "core/format/npy.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <QProcess>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

using namespace evical;
using namespace evical::test;

namespace {

template <class Number>
Number numberAt(const std::string& bytes, std::size_t place) {
  Number number = 0;
  if (place + sizeof(Number) > bytes.size()) throw std::runtime_error("the file ends too early");
  std::memcpy(&number, bytes.data() + place, sizeof(Number));
  return number;
}

std::uint32_t crcOf(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320 : 0);
  }
  return ~crc;
}

void require(bool held, const char* what) {
  if (!held) throw std::runtime_error(what);
}

// Like zipfile: the directory at the end refers to the files, whose own headers must agree with it.
std::map<std::string, std::string> filesOfZip(const std::string& zip) {
  const std::size_t end = zip.rfind("PK\x05\x06");
  require(end != std::string::npos && end + 22 == zip.size(), "no end of the directory");
  std::size_t place = numberAt<std::uint32_t>(zip, end + 16);
  require(place + numberAt<std::uint32_t>(zip, end + 12) == end, "the directory is elsewhere");
  std::map<std::string, std::string> files;
  for (int i = 0; i < numberAt<std::uint16_t>(zip, end + 10); ++i) {
    require(zip.compare(place, 4, "PK\x01\x02") == 0, "no directory entry");
    require(numberAt<std::uint16_t>(zip, place + 10) == 0, "is compressed");
    const std::size_t length = numberAt<std::uint16_t>(zip, place + 28),
                      size = numberAt<std::uint32_t>(zip, place + 24);
    const std::size_t own = numberAt<std::uint32_t>(zip, place + 42);
    const std::string name = zip.substr(place + 46, length);
    require(zip.compare(own, 4, "PK\x03\x04") == 0, "no file where the directory says");
    require(zip.compare(own + 30, length, name) == 0, "another name");
    require(zip.compare(own + 6, 20, zip, place + 8, 20) == 0, "the two headers differ");
    const std::string content = zip.substr(own + 30 + length + numberAt<std::uint16_t>(zip, own + 28), size);
    require(content.size() == size && crcOf(content) == numberAt<std::uint32_t>(zip, place + 16), "CRC");
    require(name.ends_with(".npy") && files.emplace(name.substr(0, length - 4), content).second, "name");
    place += 46 + length;
  }
  require(place == end, "the directory is longer");
  return files;
}

struct Array {
  std::string type;
  std::vector<int> shape;
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

// The header is a Python dict of exactly these keys, padded to a multiple of 64 bytes.
Array arrayOf(const std::string& npy) {
  require(npy.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) == 0, "no npy 1.0");
  const std::size_t begin = 10 + std::size_t{numberAt<std::uint16_t>(npy, 8)};
  require(begin % 64 == 0 && npy.at(begin - 1) == '\n', "header");
  static const QRegularExpression kHeader(
      R"(^\{'descr': '(<f8|<i8|<U\d+)', 'fortran_order': False, 'shape': \(((?:\d+,(?: \d+)?)?)\), \} *\n$)");
  const auto match = kHeader.match(QString::fromLatin1(npy.data() + 10, static_cast<qsizetype>(begin - 10)));
  require(match.hasMatch(), npy.substr(10, begin - 10).c_str());
  Array array{match.captured(1).toStdString(), {}, {}, {}};
  std::size_t count = 1;
  for (const QString& size : match.captured(2).split(',', Qt::SkipEmptyParts)) {
    array.shape.push_back(size.toInt());
    count *= static_cast<std::size_t>(array.shape.back());
  }
  const bool text = array.type[1] == 'U';
  const std::size_t width = text ? 4 * std::stoul(array.type.substr(2)) : 8;
  require(npy.size() == begin + count * width, "size of the numbers");
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = begin + i * width;
    if (text) {
      std::u32string points(width / 4, U'\0');
      std::memcpy(points.data(), npy.data() + place, width);
      array.texts.push_back(QString::fromStdU32String(points.substr(0, points.find(U'\0'))).toStdString());
    } else {
      array.numbers.push_back(array.type == "<i8" ? static_cast<double>(numberAt<std::int64_t>(npy, place))
                                                  : numberAt<double>(npy, place));
    }
  }
  return array;
}

std::map<std::string, Array> arraysOf(const std::string& npz) {
  std::map<std::string, Array> arrays;
  for (const auto& [name, npy] : filesOfZip(npz)) arrays[name] = arrayOf(npy);
  return arrays;
}

std::string exportedNpz(const NamedResult& result) {
  return contentOf(exportResult(result, std::vector<std::string>{"numpy"}), "numpy/calibration.npz");
}

Eigen::MatrixXd matrixOf(const Array& array) {
  require(array.shape.size() == 2, "no matrix");
  return matrix(array.numbers, array.shape[0], array.shape[1]);
}

// NumPy's printed form: name, type, shape, and all numbers or texts.
QByteArray linesOf(const std::map<std::string, Array>& arrays) {
  QByteArray lines;
  for (const auto& [name, array] : arrays) {
    lines += name.c_str() + QByteArray(" ") + array.type.c_str();
    for (const int size : array.shape) lines += " " + QByteArray::number(size);
    lines += " :";
    for (const double number : array.numbers) lines += " " + QByteArray::number(number, 'g', 17);
    for (const std::string& text : array.texts) lines += " " + QByteArray::fromStdString(text).toHex();
    lines += "\n";
  }
  return lines;
}

constexpr const char* kNumpyScript = R"(
import sys, numpy
with numpy.load(sys.argv[1], allow_pickle=False) as f:
    for name in sorted(f.files):
        a = f[name]
        values = [t.encode().hex() if a.dtype.kind == 'U' else '%.17g' % t for t in a.ravel()]
        print(' '.join([name, a.dtype.str] + [str(n) for n in a.shape] + [':'] + values))
)";

NamedResult uncertainRig(const RigKind& kind) {
  NamedResult result = rig(kind);
  CalibrationResult& own = ownResult(result);
  own.reason = "links \u00e4 \u4e2d \U0001F600";
  own.status = CalibrationStatus::Doubtful;
  own.uncertainty.cameras.resize(own.state.cameras.size());
  own.uncertainty.cameras[1].rotation_std_rad = {1e-4, 2e-4, std::numeric_limits<double>::quiet_NaN()};
  own.uncertainty.columns = {{QuantityOwner::Camera, 0, QuantityId::Rotation},
                             {QuantityOwner::Camera, 0, QuantityId::TimeOffset}};
  own.uncertainty.standard_deviations = Eigen::Vector2d(2e-4, 1e-5);
  own.uncertainty.correlation = (Eigen::Matrix2d() << 1.0, -0.5, -0.5, 1.0).finished();
  own.uncertainty.imus.resize(own.state.imus.size());
  if (!own.state.imus.empty()) own.uncertainty.imus[1].gyroscope_bias_std_rad_s = {1e-5, 2e-5, 3e-5};
  return result;
}

}  // namespace

class TestExportNumpy : public QObject {
  Q_OBJECT

 private slots:
  void cameras_reproject_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("radtan") << false;
    QTest::newRow("equidistant") << true;
  }
  void cameras_reproject() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;
    const NamedResult result = rig(kind);
    auto arrays = arraysOf(exportedNpz(result));
    QVERIFY((arrays.at("cameras").texts == std::vector<std::string>{"left", "right"}));
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string name = arrays.at("cameras").texts[i] + ".";
      const Eigen::MatrixXd k = matrixOf(arrays.at(name + "K"));
      const std::vector<double> intrinsics{k(0, 0), k(1, 1), k(0, 2), k(1, 2)};
      const std::vector<double>& d = arrays.at(name + "D").numbers;
      QCOMPARE(arrays.at(name + "model").texts[0],
               std::string(fisheye ? "pinhole_equidistant" : "pinhole_radtan"));
      QVERIFY((arrays.at(name + "resolution").numbers == std::vector<double>{346.0, 260.0}));
      const Eigen::Matrix4d ref_from_camera = matrixOf(arrays.at(name + "T_ref_cam"));
      QVERIFY(worstDifference_px(result, i,
                                 {ref_from_camera.inverse(), arrays.at(name + "time_offset_s").numbers[0],
                                  fisheye ? fisheyeLens(intrinsics, d) : radtanLens(intrinsics, d)}) < 1e-9);
    }
  }

  void imus_areAsInTheResult() {
    const NamedResult result = rig({});
    auto arrays = arraysOf(exportedNpz(result));
    QVERIFY((arrays.at("imus").texts == std::vector<std::string>{"left_imu", "far_imu"}));
    QCOMPARE(arrays.at("reference").texts[0], std::string("left_imu"));
    for (std::size_t i = 0; i < 2; ++i) {
      const ImuState& state = result.result->state.imus[i];
      const std::string name = arrays.at("imus").texts[i] + ".";
      QVERIFY((matrixOf(arrays.at(name + "gyroscope_M")) - state.gyroscopeMatrix()).norm() < 1e-15);
      QVERIFY(matrixOf(arrays.at(name + "accelerometer_M")) == state.accelerometer_scale_misalignment);
      QCOMPARE(arrays.at(name + "gyroscope_bias_rad_s").numbers[2], 1.0 / 70.0);
      QCOMPARE(arrays.at(name + "accelerometer_bias_m_s2").numbers[0], 0.11);
      QCOMPARE(arrays.at(name + "time_offset_s").numbers[0], state.time_offset_s);
      const Eigen::Matrix4d place = matrixOf(arrays.at(name + "T_ref_imu"));
      QVERIFY((place.topRightCorner<3, 1>() - state.reference_from_imu.translation_m).norm() < 1e-15);
      QCOMPARE(arrays.at(name + "rate_hz").numbers[0], 997.5);
      QCOMPARE(arrays.at(name + "gyroscope_noise_density").numbers[0], 1.5e-4);
    }
    QCOMPARE(arrays.at("gravity_m_s2").numbers[1], 9.7);
  }

  // A quantity that was not estimated has no sigma, and no zero that looks like one.
  void uncertainty_isInSiUnits() {
    auto arrays = arraysOf(exportedNpz(uncertainRig({})));
    QVERIFY(std::isnan(arrays.at("right.rotation_std").numbers[2]));
    QCOMPARE(arrays.at("right.rotation_std").numbers[1], 2e-4);
    QCOMPARE(arrays.at("far_imu.gyroscope_bias_std").numbers[2], 3e-5);
    QVERIFY(!arrays.contains("left.rotation_std") && !arrays.contains("left_imu.gyroscope_bias_std"));
    const Eigen::MatrixXd covariance = matrixOf(arrays.at("covariance"));
    QVERIFY(std::abs(covariance(0, 1) + 0.5 * 2e-4 * 1e-5) < 1e-24);
    QCOMPARE(arrays.at("covariance_names").texts[1], std::string("left.time_offset [s]"));
    QCOMPARE(arrays.at("status").texts[0], std::string("doubtful: links \u00e4 \u4e2d \U0001F600"));
    QVERIFY(!arraysOf(exportedNpz(rig({}))).contains("covariance"));
  }

  void camerasOnly_areRelativeToTheReference() {
    RigKind kind;
    kind.inertial = false;
    auto arrays = arraysOf(exportedNpz(rig(kind)));
    QCOMPARE(arrays.at("reference").texts[0], std::string("left"));
    QVERIFY(arrays.at("imus").texts.empty() && arrays.at("imus").shape == std::vector<int>{0});
    QVERIFY(!arrays.contains("gravity_m_s2"));
  }

  void brokenText_isNoObstacle() {
    const Array array = arrayOf(npyText(std::string("a\xC3") + "\xFFz\xE4\xB8"));
    QCOMPARE(array.texts[0], std::string("a\uFFFD\uFFFDz\uFFFD"));
  }

  // The same arrays as read by this test.
  void numpy_readsThem() {
    if (QProcess::execute("/usr/bin/python3", {"-c", "import numpy"}) != 0)
      QSKIP("python3-numpy is not installed");
    QTemporaryDir folder;
    const std::string npz = exportedNpz(uncertainRig({}));
    const std::string path = folder.filePath("calibration.npz").toStdString();
    std::ofstream(path, std::ios::binary) << npz;
    QProcess python;
    python.start("/usr/bin/python3", {"-c", kNumpyScript, QString::fromStdString(path)});
    QVERIFY(python.waitForFinished(60'000));
    QVERIFY2(python.exitCode() == 0, python.readAllStandardError().constData());
    QCOMPARE(QString::fromUtf8(python.readAllStandardOutput()), QString::fromUtf8(linesOf(arraysOf(npz))));
  }
};

EVICAL_TEST(TestExportNumpy)
#include "tst_export_numpy.moc"
