// The calib groups of M3ED's files: written there by insert_calibration of daniilidis-group/m3ed
// (build_system/bag_processing/rosbag2hdf5.py, 2b39788), read by its load_remapping
// (build_system/semantics/internimage.py, 2b39788).
#include "tests/core/export/exported_rig.h"
#include "tests/support/test_program.h"

#include <hdf5.h>
#include <Eigen/LU>
#include <QProcess>
#include <QTemporaryDir>

#include <fstream>

using namespace evical;
using namespace evical::test;

namespace {

ExportedFiles exported(const NamedResult& result) {
  return exportResult(result, std::vector<std::string>{"m3ed"});
}

NamedResult eventsAndFramesForExportM3ed() {
  RigKind kind;
  kind.frames = 2;
  return rig(kind);
}

// A file in memory, as HDF5's own library reads it.
class File {
 public:
  explicit File(const std::string& content) : content_(content) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 4096, false);
    H5Pset_file_image(access, content_.data(), content_.size());
    file_ = H5Fopen("in memory", H5F_ACC_RDONLY, access);
    H5Pclose(access);
    if (file_ < 0) throw std::runtime_error("no HDF5");
  }
  ~File() { H5Fclose(file_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool has(const std::string& path) const { return H5Lexists(file_, path.c_str(), H5P_DEFAULT) > 0; }

  std::vector<double> numbers(const std::string& path, const std::vector<hsize_t>& shape,
                              H5T_class_t kind) const {
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset),
                space = H5Dget_space(dataset);
    std::vector<hsize_t> found(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, found.data(), nullptr);
    if (found != shape || H5Tget_class(type) != kind || H5Tget_size(type) != 8)
      throw std::runtime_error(path);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(dataset);
    return values;
  }

  std::string text(const std::string& path) const {
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset);
    if (H5Tis_variable_str(type) <= 0) throw std::runtime_error(path);
    char* characters = nullptr;
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(&characters));
    const std::string read = characters;
    H5free_memory(characters);
    H5Tclose(type);
    H5Dclose(dataset);
    return read;
  }

  Eigen::Matrix4d place(const std::string& group) const {
    return matrix(numbers(group + "/calib/T_to_prophesee_left", {4, 4}, H5T_FLOAT), 4, 4);
  }

  Lens lens(const std::string& group) const {
    if (text(group + "/calib/camera_model") != "pinhole" ||
        text(group + "/calib/distortion_model") != "radtan")
      throw std::runtime_error("another lens");
    if (numbers(group + "/calib/resolution", {2}, H5T_INTEGER) != std::vector<double>{346.0, 260.0})
      throw std::runtime_error("resolution");
    return radtanLens(numbers(group + "/calib/intrinsics", {4}, H5T_FLOAT),
                      numbers(group + "/calib/distortion_coeffs", {4}, H5T_FLOAT));
  }

 private:
  std::string content_;
  hid_t file_ = -1;
};

// The keys that load_remapping reads from a group and passes to cv2.
constexpr const char* kTheirScript = R"(
import sys, h5py, numpy as np
f = h5py.File(sys.argv[1], 'r')
for name in ['prophesee/left', 'prophesee/right', 'ovc/left', 'ovc/right']:
    calib = f['/' + name]['calib']
    width, height = calib['resolution'][...]
    numbers = np.concatenate([calib['T_to_prophesee_left'][...].ravel(), calib['distortion_coeffs'][...], calib['intrinsics'][...]])
    print(name, calib['camera_model'][()].decode(), calib['distortion_model'][()].decode(), width, height,
          *['%.17g' % x for x in numbers])
print('imu', *['%.17g' % x for x in f['/ovc/imu/calib/T_to_prophesee_left'][...].ravel()])
print(f.attrs['comment'].split('.')[0])
)";

}  // namespace

class TestExportM3ed : public QObject {
  Q_OBJECT

 private slots:
  void sensors_reproject() {
    const NamedResult result = eventsAndFramesForExportM3ed();
    const File file(contentOf(exported(result), "m3ed/calibration.h5"));
    const Eigen::Matrix4d left_from_imu = file.place("/ovc/imu");
    const char* const groups[] = {"/prophesee/left", "/prophesee/right", "/ovc/left", "/ovc/right"};
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Matrix4d camera_from_left = file.place(groups[i]).inverse();
      QVERIFY(worstDifference_px(result, i,
                                 {camera_from_left * left_from_imu,
                                  result.result->state.cameras[i].time_offset_s, file.lens(groups[i])}) <
              1e-9);
    }
    // Its readers require exact values.
    QVERIFY(file.place("/prophesee/left") == Eigen::Matrix4d::Identity());
  }

  void whatIsMissing_hasNoGroup() {
    RigKind kind;
    kind.inertial = false;
    kind.cameras = 1;
    kind.third_radial = true;
    const ExportedFiles files = exported(rig(kind));
    const File file(contentOf(files, "m3ed/calibration.h5"));
    QVERIFY(file.has("/prophesee/left/calib") && !file.has("/ovc") && !file.has("/prophesee/right"));
    const std::string text = contentOf(files, "m3ed/README.txt");
    QVERIFY(text.find("M3ED does not support radial-tangential distortion with k3") != std::string::npos);
    QVERIFY(text.find("add to the stamps of left 0.007301 s") != std::string::npos);
  }

  void bytes_areTheSameAgain() {
    const NamedResult result = eventsAndFramesForExportM3ed();
    const std::string content = contentOf(exported(result), "m3ed/calibration.h5");
    QTest::qSleep(1100);  // stamps of HDF5 are seconds
    QVERIFY(contentOf(exported(result), "m3ed/calibration.h5") == content);
  }

  void h5py_readsThem() {
    if (QProcess::execute("/usr/bin/python3", {"-c", "import h5py"}) != 0)
      QSKIP("python3-h5py is not installed");
    QTemporaryDir folder;
    const std::string content = contentOf(exported(eventsAndFramesForExportM3ed()), "m3ed/calibration.h5");
    const QString path = folder.filePath("calibration.h5");
    std::ofstream(path.toStdString(), std::ios::binary) << content;
    QProcess python;
    python.start("/usr/bin/python3", {"-c", kTheirScript, path});
    QVERIFY(python.waitForFinished(60'000));
    QVERIFY2(python.exitCode() == 0, python.readAllStandardError().constData());
    const File file(content);
    QStringList expected;
    const auto append = [](QString& line, const std::vector<double>& numbers) {
      for (const double number : numbers) line += " " + QString::number(number, 'g', 17);
    };
    for (const char* const group : {"/prophesee/left", "/prophesee/right", "/ovc/left", "/ovc/right"}) {
      const std::string calib = std::string(group) + "/calib/";
      QString line = QString(group).mid(1) + " pinhole radtan 346 260";
      append(line, file.numbers(calib + "T_to_prophesee_left", {4, 4}, H5T_FLOAT));
      append(line, file.numbers(calib + "distortion_coeffs", {4}, H5T_FLOAT));
      append(line, file.numbers(calib + "intrinsics", {4}, H5T_FLOAT));
      expected << line;
    }
    QString imu = "imu";
    append(imu, file.numbers("/ovc/imu/calib/T_to_prophesee_left", {4, 4}, H5T_FLOAT));
    expected << imu << "Written by Evical 0";
    QCOMPARE(QString::fromUtf8(python.readAllStandardOutput()).trimmed().split('\n'), expected);
  }
};

EVICAL_TEST(TestExportM3ed)
#include "tst_export_m3ed.moc"
