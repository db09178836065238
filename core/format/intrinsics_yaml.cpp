#include "core/format/intrinsics_yaml.h"

#include "core/base/file_places.h"
#include "core/base/nearest_name.h"
#include "core/base/plain_text.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/sphere_lens.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace evical {
namespace {

// Larger than any expected sensor, and small enough that width * height fits an int.
constexpr int kMaxPixels = 30000;

Eigen::Vector2d pair(const YamlNode& node) {
  const std::vector<double> values = node.reals(2);
  return {values[0], values[1]};
}

Resolution resolution(const YamlNode& node) {
  const std::vector<YamlNode> items = node.items();
  if (items.size() != 2) throw node.error("must be [width, height]");
  return {items[0].integer(1, kMaxPixels), items[1].integer(1, kMaxPixels)};
}

void setDistortion(const YamlNode& node, CameraIntrinsics& camera) {
  const std::vector<double> values = node.reals();
  const bool radtan = camera.model == CameraModel::PinholeRadtan;
  const auto count = static_cast<std::size_t>(coefficientCount(camera.model));
  if (values.size() != count && !(radtan && values.size() == 4)) {
    const auto names = distortionNames(camera.model);
    throw node.error(
        fmt::format("has {} coefficients", values.size()),
        radtan ? "Give k1, k2, p1, p2 and optionally k3"
               : fmt::format("Give {}",
                             fmt::join(names.begin(), names.begin() + static_cast<int>(count), ", ")));
  }
  camera.distortion = {};
  std::copy(values.begin(), values.end(), camera.distortion.begin());
}

CameraIntrinsics readOwn(const YamlNode& map) {
  map.allowOnly({"model", "resolution_px", "focal_length_px", "principal_point_px", "distortion"});
  CameraIntrinsics camera;
  camera.model = static_cast<CameraModel>(map["model"].choice(kCameraModelNames));
  if (const auto node = map.find("resolution_px")) camera.resolution_px = resolution(*node);
  camera.focal_length_px = pair(map["focal_length_px"]);
  camera.principal_point_px = pair(map["principal_point_px"]);
  setDistortion(map["distortion"], camera);
  return camera;
}

// The numbers before the focal lengths belong to the model: [xi alpha], [alpha beta], [xi], or none.
CameraIntrinsics kalibrLens(const YamlNode& node, CameraModel model, std::size_t own) {
  const std::vector<double> values = node.reals(own + 4);
  CameraIntrinsics camera;
  camera.model = model;
  std::copy_n(values.begin(), own, camera.distortion.begin());
  camera.focal_length_px = {values[own], values[own + 1]};
  camera.principal_point_px = {values[own + 2], values[own + 3]};
  return camera;
}

CameraIntrinsics readKalibrOmni(const YamlNode& map) {
  CameraIntrinsics camera = kalibrLens(map["intrinsics"], CameraModel::OmniRadtan, 1);
  if (map["distortion_model"].choice({"radtan", "none"}) == 1) return camera;
  const std::vector<double> values = map["distortion_coeffs"].reals(4);
  std::copy(values.begin(), values.end(), camera.distortion.begin() + 1);
  return camera;
}

// The first of these keys in the map. If all are missing, the error names the first one.
YamlNode anyOf(const YamlNode& map, std::initializer_list<const char*> keys) {
  for (const char* const key : keys)
    if (const auto node = map.find(key)) return *node;
  return map[*keys.begin()];
}

CameraIntrinsics readKalibrPinhole(const YamlNode& map) {
  if (const YamlNode model = map["distortion_model"]; model.text() == "fov")
    throw model.error("is the fov model, which is not supported",
                      "Calibrate this camera again with radtan or equidistant");
  const std::size_t distortion =
      map["distortion_model"].choice({"radtan", "equidistant", "none", "radial-tangential"});
  const CameraModel model = distortion == 1 ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan;
  CameraIntrinsics camera = kalibrLens(map["intrinsics"], model, 0);
  if (distortion != 2) setDistortion(anyOf(map, {"distortion_coeffs", "distortion_coefficients"}), camera);
  return camera;
}

CameraIntrinsics readKalibrSphere(const YamlNode& map, CameraModel model) {
  if (const auto distortion = map.find("distortion_model")) distortion->choice({"none"});
  return kalibrLens(map["intrinsics"], model, 2);
}

// Also reads cameras of EuRoC and Kimera, whose keys differ from Kalibr's in two names. Other keys
// (T_cam_imu, rostopic, ...) are ignored.
CameraIntrinsics readKalibr(const YamlNode& map) {
  const std::size_t kind = map["camera_model"].choice({"pinhole", "ds", "eucm", "omni"});
  CameraIntrinsics camera =
      kind == 0   ? readKalibrPinhole(map)
      : kind == 3 ? readKalibrOmni(map)
                  : readKalibrSphere(map, kind == 1 ? CameraModel::DoubleSphere : CameraModel::Eucm);
  if (const auto node = map.find("resolution")) camera.resolution_px = resolution(*node);
  return camera;
}

// OpenCV's matrix {rows, cols, data}, or the numbers alone.
YamlNode numbersOf(const YamlNode& node) {
  return node.isMap() ? node["data"] : node;
}

// OpenCV's order: k1 k2 p1 p2 k3, and the rational model's k4 k5 k6, thin prism and tilt, which must be zero
// here; or the four of a fisheye lens, which an OAK fills up with zeros.
void setOpenCvDistortion(const YamlNode& node, CameraIntrinsics& camera) {
  const std::vector<double> all = node.reals();
  const auto used = static_cast<std::size_t>(coefficientCount(camera.model));
  if (all.size() <= used) return setDistortion(node, camera);
  if (std::any_of(all.begin() + static_cast<std::ptrdiff_t>(used), all.end(),
                  [](double each) { return each != 0.0; }))
    throw node.error(
        camera.model == CameraModel::PinholeRadtan
            ? "are those of a rational lens model; at most three radial coefficients are supported"
            : "has more than the four coefficients of a fisheye lens",
        "Calibrate this camera again, or export it with the further coefficients fixed at zero");
  std::copy_n(all.begin(), used, camera.distortion.begin());
}

void setMatrix(std::span<const double> matrix, const std::string& place, CameraIntrinsics& camera) {
  const auto [fx, fy, cx, cy] = cameraMatrixNumbers(matrix, place);
  camera.focal_length_px = {fx, fy};
  camera.principal_point_px = {cx, cy};
}

// ROS names it distortion_model, older files camera_model; files without a name have OpenCV's five
// coefficients.
CameraModel rosModel(const YamlNode& map, const YamlNode& distortion) {
  const auto name = map.has("distortion_model") ? map.find("distortion_model") : map.find("camera_model");
  if (!name) {
    if (distortion.reals().size() >= 5) return CameraModel::PinholeRadtan;
    throw distortion.error("fits two models, and distortion_model is missing",
                           "Add distortion_model: plumb_bob, or equidistant");
  }
  const std::size_t model = name->choice({"plumb_bob", "rational_polynomial", "equidistant", "fisheye"});
  return model < 2 ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant;
}

// sensor_msgs/CameraInfo as written by camera_calibration_parsers, or printed by `rostopic echo` or `ros2
// topic echo`.
// The lens of a camera_info is that of the whole sensor, but its pictures may be binned, or show a part.
void refusePartOfImage(const YamlNode& map, const Resolution& size_px) {
  constexpr const char* kAdvice = "Give the lens of the recorded pictures";
  for (const char* const key : {"binning_x", "binning_y"}) {
    const auto binning = map.find(key);
    const int pixels = binning ? binning->integer(0, kMaxPixels) : 0;
    if (pixels > 1)
      throw binning->error(fmt::format("is {}: the pictures have fewer pixels than the lens is for", pixels),
                           kAdvice);
  }
  const auto roi = map.find("roi");
  if (!roi || !roi->isMap()) return;
  const auto numberOf = [&](const char* key) {
    const auto number = roi->find(key);
    return number ? number->integer(0, kMaxPixels) : 0;
  };
  const int width_px = numberOf("width"), height_px = numberOf("height");
  if (numberOf("x_offset") > 0 || numberOf("y_offset") > 0 ||
      (width_px > 0 && width_px != size_px.width_px) || (height_px > 0 && height_px != size_px.height_px))
    throw roi->error("is a part of the image, but the lens is that of the whole one", kAdvice);
}

CameraIntrinsics readCameraInfo(const YamlNode& map) {
  const bool parsers = map.has("camera_matrix");
  const YamlNode distortion = numbersOf(anyOf(map, {"distortion_coefficients", "D", "d"}));
  CameraIntrinsics camera;
  camera.model = rosModel(map, distortion);
  const YamlNode matrix = numbersOf(anyOf(map, {"camera_matrix", "K", "k"}));
  setMatrix(matrix.reals(9), matrix.place(), camera);
  setOpenCvDistortion(distortion, camera);
  const char* prefix = parsers ? "image_" : "";
  camera.resolution_px = {map[fmt::format("{}width", prefix)].integer(1, kMaxPixels),
                          map[fmt::format("{}height", prefix)].integer(1, kMaxPixels)};
  refusePartOfImage(map, camera.resolution_px);
  return camera;
}

// A camera of a Luxonis OAK. Source: luxonis/depthai-shared, include/depthai-shared/common/CameraModel.hpp:
// the types.
CameraIntrinsics readOak(const YamlNode& map) {
  constexpr const char* kTypes[] = {"Perspective", "Fisheye", "Equirectangular", "RadialDivision"};
  const auto type = map.find("cameraType");
  const int number = type ? type->integer(0, 3) : 0;
  if (number > 1)
    throw type->error(fmt::format("is {} ({}), a lens model that is not supported", number, kTypes[number]),
                      "Calibrate this camera again as Perspective or Fisheye");
  CameraIntrinsics camera;
  camera.model = number == 0 ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant;
  std::vector<double> matrix;
  for (const YamlNode& row : map["intrinsicMatrix"].items())
    for (const double each : row.reals(3)) matrix.push_back(each);
  setMatrix(matrix, map["intrinsicMatrix"].place(), camera);
  setOpenCvDistortion(map["distortionCoeff"], camera);
  camera.resolution_px = {map["width"].integer(1, kMaxPixels), map["height"].integer(1, kMaxPixels)};
  return camera;
}

// eKalibr's order k1 k2 k3 t1 t2; Evical and OpenCV have k3 last.
CameraIntrinsics readEkalibr(const YamlNode& map) {
  CameraIntrinsics camera;
  camera.model =
      static_cast<CameraModel>(map["polymorphic_name"].choice({"pinhole_brown_t2", "pinhole_fisheye"}));
  const YamlNode data = map["ptr_wrapper"]["data"];
  camera.resolution_px = {data["img_width"].integer(1, kMaxPixels),
                          data["img_height"].integer(1, kMaxPixels)};
  camera.focal_length_px = pair(data["focal_length"]);
  camera.principal_point_px = pair(data["principal_point"]);
  if (camera.model == CameraModel::PinholeEquidistant) {
    setDistortion(data["disto_param"], camera);
  } else {
    const std::vector<double> d = data["disto_param"].reals(5);
    camera.distortion = {d[0], d[1], d[3], d[4], d[2]};
  }
  return camera;
}

bool namesStream(const YamlNode& camera, const std::string& stream) {
  const auto topic = camera.isMap() ? camera.find("rostopic") : std::nullopt;
  return topic && topic->isScalar() && topic->text() == stream;
}

// The camera with this name or stream, or the only one.
YamlNode pickCamera(const YamlNode& file, const std::vector<std::pair<std::string, YamlNode>>& cameras,
                    const std::string& name, const std::string& stream) {
  std::vector<std::string> names;
  for (const auto& [key, camera] : cameras) {
    if (key == name) return camera;
    names.push_back(key);
  }
  for (const auto& [key, camera] : cameras)
    if (namesStream(camera, stream)) return camera;
  if (cameras.size() == 1) return cameras.front().second;
  throw file.error(
      fmt::format("has several cameras, but none with the name '{}' or rostopic '{}'", name, stream),
      fmt::format("Use one of: {}", joined(names)));
}

std::vector<std::pair<std::string, YamlNode>> named(const YamlNode& map,
                                                    const std::vector<std::string>& keys) {
  std::vector<std::pair<std::string, YamlNode>> values;
  for (const std::string& key : keys) values.emplace_back(key, map[key]);
  return values;
}

// Without a resolution, the recording gives it.
CameraIntrinsics withAnySize(CameraIntrinsics camera) {
  if (!camera.resolution_px.known()) camera.resolution_px = {kMaxPixels, kMaxPixels};
  return camera;
}

// Correlation of `count` numbers from the first one on; other intrinsics are uncorrelated. Accepts matrices
// that are only invalid because of rounding.
IntrinsicsMatrix readCorrelation(const YamlNode& node, Eigen::Index first, Eigen::Index count) {
  const std::vector<YamlNode> rows = node.items();
  if (static_cast<Eigen::Index>(rows.size()) < first + count)
    throw node.error(fmt::format("has {} rows", rows.size()),
                     fmt::format("Give {}: fx, fy, cx, cy and the coefficients", count));
  IntrinsicsMatrix matrix = IntrinsicsMatrix::Identity();
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::vector<double> values = rows[static_cast<std::size_t>(first + row)].reals(rows.size());
    for (Eigen::Index column = 0; column < count; ++column)
      matrix(row, column) = values[static_cast<std::size_t>(first + column)];
  }
  constexpr double kRounded = 1e-3;
  const IntrinsicsMatrix lifted = matrix + kRounded * IntrinsicsMatrix::Identity();
  if (!matrix.isApprox(matrix.transpose(), kRounded) ||
      (matrix.diagonal().array() - 1.0).abs().maxCoeff() > kRounded || lifted.llt().info() != Eigen::Success)
    throw node.error("is not a correlation matrix",
                     "Give a symmetric matrix with 1 on the diagonal and other values from -1 to 1");
  return matrix;
}

// Correlation in a result, whose matrix covers all quantities.
std::optional<IntrinsicsMatrix> correlationInResult(const YamlNode& root, const std::string& camera,
                                                    int count) {
  const auto uncertainty = root.find("uncertainty");
  if (!uncertainty) return std::nullopt;
  const std::vector<YamlNode> columns = (*uncertainty)["columns"].items();
  const auto first = std::ranges::find_if(columns, [&](const YamlNode& column) {
    const auto owner = column.find("camera");
    return owner && owner->text() == camera && column["quantity"].text() == "intrinsics";
  });
  if (first == columns.end()) return std::nullopt;
  return readCorrelation((*uncertainty)["correlation"], first - columns.begin(), count);
}

// Reads the map of `intrinsics`, with sigmas if known.
KnownIntrinsics withSigmas(const YamlNode& beside) {
  KnownIntrinsics known{readIntrinsics(beside["intrinsics"]), {}};
  if (const auto sigmas = beside.find("intrinsics_std"))
    known.uncertainty = readLensUncertainty(*sigmas, beside.find("correlation"), known.camera);
  return known;
}

// Keys of a lens that are read, or that need no note.
constexpr std::string_view kLensKeys[] = {
    "camera_model", "intrinsics", "distortion_model", "distortion_coeffs", "resolution", "rostopic",
    "cam_overlaps", "image_width", "image_height", "width", "height", "camera_name", "camera_matrix",
    "distortion_coefficients", "K", "k", "D", "d", "projection_matrix", "P", "p", "rectification_matrix", "R",
    "r", "header", "binning_x", "binning_y", "roi",
    // reported by the import
    "T_cam_imu", "T_cn_cnm1", "timeshift_cam_imu",
    // keys of Evical, eKalibr and OAK
    "model", "resolution_px", "focal_length_px", "principal_point_px", "distortion", "Intrinsics",
    "intrinsics_std", "correlation", "cameraData", "cameraType", "intrinsicMatrix", "distortionCoeff"};

// Converts ost.txt to the keys of camera_info: headings, each followed by rows of numbers.
std::string cameraInfoOf(const std::string& text) {
  std::map<std::string, std::string> numbers;
  std::istringstream lines(text);
  std::string line, heading;
  while (std::getline(lines, line)) {
    const std::string_view plain = trimmed(line);
    if (plain.empty() || plain.front() == '#' || plain.front() == '[') continue;
    if (std::isalpha(static_cast<unsigned char>(plain.front())) != 0) {
      heading = plain;
      continue;
    }
    std::istringstream words{std::string(plain)};
    for (std::string word; words >> word;) numbers[heading] += (numbers[heading].empty() ? "" : ", ") + word;
  }
  const std::string distortion = numbers["distortion"];
  return fmt::format(
      "image_width: {}\nimage_height: {}\ncamera_matrix: [{}]\ndistortion_model: "
      "{}\ndistortion_coefficients: [{}]\n"
      "projection_matrix: [{}]\n",
      numbers["width"], numbers["height"], numbers["camera matrix"],
      std::count(distortion.begin(), distortion.end(), ',') >= 4 ? "plumb_bob" : "", distortion,
      numbers["projection"]);
}

}  // namespace

std::vector<std::string> camchainCameras(const YamlNode& root) {
  std::vector<std::string> cameras;
  if (!root.isMap()) return cameras;
  for (const std::string& key : root.keys()) {
    const bool numbered = key.starts_with("cam") && key.size() > 3 &&
                          key.find_first_not_of("0123456789", 3) == std::string::npos;
    if (numbered && root[key].isMap()) cameras.push_back(key);
  }
  if (!cameras.empty() && root.has("camera_model"))
    throw root["camera_model"].error(fmt::format("belongs to no camera, but {} to one", cameras.front()),
                                     "Add the line 'cam0:' of the first camera, and indent its lines");
  return cameras;
}

std::vector<std::pair<std::string, YamlNode>> oakCameras(const YamlNode& root) {
  std::vector<std::pair<std::string, YamlNode>> cameras;
  if (!root.isMap() || !root.has("cameraData")) return cameras;
  for (const YamlNode& pair : root["cameraData"].items()) {
    const std::vector<YamlNode> parts = pair.items();
    if (parts.size() != 2)
      throw pair.error("must be a pair of a socket and its camera", "Give an OAK's own file");
    if (!parts[1]["intrinsicMatrix"].items().empty())
      cameras.emplace_back(fmt::format("cam{}", parts[0].integer(0, 1000)), parts[1]);
  }
  if (cameras.empty())
    throw root["cameraData"].error("has no camera with intrinsics", "Give a calibration with a camera");
  return cameras;
}

bool isLens(const YamlNode& root) {
  for (const char* const key :
       {"Intrinsics", "camera_matrix", "camera_model", "K", "k", "focal_length_px", "cameraData"})
    if (root.has(key)) return true;
  return false;
}

CameraIntrinsics readIntrinsics(const YamlNode& map) {
  if (!map.isMap()) throw map.error("must be a map of intrinsics", "Give model, focal_length_px, ...");
  const bool foreign = !map.has("focal_length_px");
  const CameraIntrinsics camera = map.has("polymorphic_name")  ? readEkalibr(map)
                                  : map.has("intrinsicMatrix") ? readOak(map)
                                  : map.has("camera_matrix") || map.has("K") || map.has("k")
                                      ? readCameraInfo(map)
                                  : map.has("camera_model") ? readKalibr(map)
                                                            : readOwn(map);
  if (foreign)
    validateImported(camera, map.place());
  else
    validate(withAnySize(camera), map.place());
  return camera;
}

namespace {

// Follows rays from the optical axis towards a place on the image's border: how much the lens magnifies there
// must change little. Real lenses are far within these limits, also badly calibrated ones.
void refuseImplausibleDistortion(const CameraIntrinsics& camera, const Eigen::Vector2d& border_px,
                                 const std::string& place) {
  constexpr double kStep_rad = 0.01, kWidest_rad = 1.4, kWeakest = 0.1, kStrongest = 4.0, kMaxOfTheWay = 0.6;
  constexpr const char* kAdvice = "Check the model, the order and the unit of the coefficients";
  const Eigen::Vector2d way_px = border_px - camera.principal_point_px;
  const Eigen::Vector2d away = way_px.cwiseQuotient(camera.focal_length_px).normalized();
  Eigen::Vector2d last_px = camera.principal_point_px;
  double middle_px = 0.0;  // pixels per step on the axis
  for (double angle_rad = kStep_rad; angle_rad < kWidest_rad; angle_rad += kStep_rad) {
    const Eigen::Vector2d aside = std::sin(angle_rad) * away;
    const auto pixel = project(camera, {aside.x(), aside.y(), std::cos(angle_rad)});
    const double share = (last_px - camera.principal_point_px).norm() / way_px.norm();
    if (share >= 1.0) return;
    if (!pixel && share < kMaxOfTheWay)
      throw badInput(
          place,
          fmt::format("the distortion folds the image at {:.0f} deg off the axis", angle_rad * kDegPerRad),
          kAdvice);
    if (!pixel) return;
    const double step_px = (*pixel - last_px).norm();
    if (middle_px == 0.0) middle_px = step_px;
    last_px = *pixel;
    // A pinhole without distortion magnifies as the derivative of the tangent.
    const double pinhole =
        camera.model == CameraModel::PinholeRadtan ? std::pow(std::cos(angle_rad - 0.5 * kStep_rad), 2) : 1.0;
    if (step_px > kWeakest * middle_px && step_px * pinhole < kStrongest * middle_px) continue;
    throw badInput(
        place,
        fmt::format("the distortion is implausible: at {:.0f} deg off the axis, the lens magnifies "
                    "{:.2g} times as much as on it",
                    angle_rad * kDegPerRad, step_px / middle_px),
        kAdvice);
  }
}

}  // namespace

void validateImported(const CameraIntrinsics& camera, const std::string& place) {
  validate(withAnySize(camera), place);
  constexpr double kMinFocal_px = 5.0, kMaxFocal_px = 1e7;  // a telescope has less
  const Eigen::Vector2d &focal = camera.focal_length_px, &centre = camera.principal_point_px;
  for (const double each : {focal.x(), focal.y()})
    if (!(each >= kMinFocal_px && each <= kMaxFocal_px))
      throw badInput(place, fmt::format("the focal length of {:.3g} px is implausible", each),
                     "Give it in pixels");
  const Resolution size = camera.resolution_px;
  const bool inside = centre.x() > 0.0 && centre.y() > 0.0 &&
                      (!size.known() || (centre.x() < size.width_px && centre.y() < size.height_px));
  if (!inside)
    throw badInput(
        place,
        fmt::format("the principal point ({:.1f}, {:.1f}) is outside the image{}", centre.x(), centre.y(),
                    size.known() ? fmt::format(" of {} x {}", size.width_px, size.height_px) : ""),
        "Check that the resolution and the intrinsics belong together");
  if (!size.known()) return;
  const Eigen::Vector2d last(size.width_px - 1, size.height_px - 1);
  for (const double x : {0.0, 0.5, 1.0})
    for (const double y : {0.0, 0.5, 1.0})
      if (x != 0.5 || y != 0.5) refuseImplausibleDistortion(camera, {x * last.x(), y * last.y()}, place);
}

std::array<double, 4> cameraMatrixNumbers(std::span<const double> k, const std::string& place) {
  if (k.size() != 9) throw badInput(place, "is not a 3 x 3 matrix", "Give fx 0 cx, 0 fy cy, 0 0 1");
  constexpr double kNone_px = 1e-3, kRounded = 1e-6;
  if (std::abs(k[1]) > kNone_px)
    throw badInput(place, fmt::format("has a skew of {:.4g} px, which is not supported", k[1]),
                   "Calibrate this camera again without skew");
  for (const std::size_t zero : {3U, 6U, 7U})
    if (std::abs(k[zero]) > kRounded)
      throw badInput(place, fmt::format("has {:.4g} below its diagonal, as if it were transposed", k[zero]),
                     "Give fx 0 cx, 0 fy cy, 0 0 1, row by row");
  if (std::abs(k[8] - 1.0) > kRounded)
    throw badInput(place, fmt::format("has {:.4g} as its last number instead of 1", k[8]),
                   "Divide the matrix by it, if it is a factor of all numbers");
  return {k[0], k[4], k[2], k[5]};
}

CameraIntrinsics readIntrinsicsFile(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream) {
  return readKnownIntrinsics(file, camera_name, stream).camera;
}

YamlNode loadIntrinsics(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest_bytes = 1 << 16;
  std::string text = contentOfFile(file, kLargest_bytes);
  if (text.size() == kLargest_bytes) text.clear();
  const bool ost =
      text.find("[image]") != std::string::npos && text.find("camera matrix") != std::string::npos;
  return ost ? YamlNode::parse(cameraInfoOf(text), file.string()) : YamlNode::load(file);
}

std::vector<std::string> leftOutOf(const YamlNode& lens) {
  std::vector<std::string> notes;
  if (!lens.isMap()) return notes;
  std::vector<std::string> others;
  for (const std::string& key : lens.keys())
    if (std::find(std::begin(kLensKeys), std::end(kLensKeys), key) == std::end(kLensKeys))
      others.push_back(key);
  if (!others.empty()) notes.push_back(fmt::format("left out: {}", joined(others)));
  const auto projection = lens.has("projection_matrix") ? lens.find("projection_matrix") : lens.find("P");
  const bool has_matrix = lens.has("camera_matrix") || lens.has("K");
  if (!projection || !has_matrix) return notes;
  const std::vector<double> p = numbersOf(*projection).reals(),
                            k = numbersOf(anyOf(lens, {"camera_matrix", "K"})).reals(9);
  constexpr double kSame_px = 1e-3;
  if (p.size() == 12 && p[0] != 0.0 &&
      (std::abs(p[0] - k[0]) > kSame_px || std::abs(p[5] - k[4]) > kSame_px ||
       std::abs(p[2] - k[2]) > kSame_px || std::abs(p[6] - k[5]) > kSame_px || std::abs(p[3]) > kSame_px))
    notes.emplace_back("its projection matrix is for rectified images and is left out");
  return notes;
}

KnownIntrinsics readKnownIntrinsics(const std::filesystem::path& file, const std::string& camera_name,
                                    const std::string& stream) {
  const YamlNode root = loadIntrinsics(file);
  if (!root.isMap())
    throw root.error("has no camera intrinsics", "Give intrinsics in the format of Evical, Kalibr or ROS");
  if (root.has("evical_result")) {
    const YamlNode cameras = root["cameras"];
    const YamlNode camera = pickCamera(cameras, named(cameras, cameras.keys()), camera_name, stream);
    KnownIntrinsics known = withSigmas(camera);
    const std::string name = camera.key().substr(camera.key().rfind('.') + 1);
    if (known.uncertainty)
      known.uncertainty->correlation = correlationInResult(root, name, 4 + distortionCount(known.camera));
    return known;
  }
  std::vector<std::pair<std::string, YamlNode>> cameras = named(root, camchainCameras(root));
  if (cameras.empty()) cameras = oakCameras(root);
  if (!cameras.empty()) return {readIntrinsics(pickCamera(root, cameras, camera_name, stream)), {}};
  if (root.has("Intrinsics")) return {readIntrinsics(root["Intrinsics"]), {}};
  if (root.has("intrinsics") && root["intrinsics"].isMap()) return withSigmas(root);
  return {readIntrinsics(root), {}};
}

LensUncertainty readLensUncertainty(const YamlNode& sigmas, const std::optional<YamlNode>& correlation,
                                    const CameraIntrinsics& camera) {
  sigmas.allowOnly({"focal_length_px", "principal_point_px", "distortion"});
  LensUncertainty uncertainty;
  const auto count = static_cast<std::size_t>(distortionCount(camera));
  const auto take = [&](const char* key, std::size_t numbers, Eigen::Index at) {
    const YamlNode node = sigmas[key];
    const std::vector<double> values = node.reals(numbers);
    if (*std::min_element(values.begin(), values.end()) < 0.0)
      throw node.error("has a sigma below 0", "Use 0 for the default sigma");
    std::copy(values.begin(), values.end(), uncertainty.std.begin() + at);
  };
  take("focal_length_px", 2, 0);
  take("principal_point_px", 2, 2);
  take("distortion", count, 4);
  if (correlation)
    uncertainty.correlation = readCorrelation(*correlation, 0, static_cast<Eigen::Index>(4 + count));
  return uncertainty;
}

std::string lensUncertaintyYaml(const LensUncertainty& uncertainty, const CameraIntrinsics& camera,
                                int indent) {
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  const IntrinsicsVector& s = uncertainty.std;
  const Eigen::Index count = 4 + distortionCount(camera);
  const auto list = [](const auto& numbers) {
    std::string text;
    for (const double number : numbers) text += fmt::format("{}{}", text.empty() ? "" : ", ", number);
    return "[" + text + "]";
  };
  std::string text = fmt::format(
      "{0}intrinsics_std:\n{0}  focal_length_px: {1}\n{0}  principal_point_px: {2}\n{0}  distortion: {3}\n",
      blanks, list(s.segment<2>(0)), list(s.segment<2>(2)), list(s.segment(4, count - 4)));
  if (!uncertainty.correlation) return text;
  text += blanks + "intrinsics_correlation:\n";
  for (Eigen::Index row = 0; row < count; ++row)
    text += fmt::format("{}  - {}\n", blanks, list(uncertainty.correlation->row(row).head(count)));
  return text;
}

std::string intrinsicsYaml(const CameraIntrinsics& camera, int indent) {
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  std::string text = fmt::format("{}model: {}\n", blanks, cameraModelName(camera.model));
  if (camera.resolution_px.known())
    text += fmt::format("{}resolution_px: [{}, {}]\n", blanks, camera.resolution_px.width_px,
                        camera.resolution_px.height_px);
  text += fmt::format("{}focal_length_px: [{}, {}]\n", blanks, camera.focal_length_px.x(),
                      camera.focal_length_px.y());
  text += fmt::format("{}principal_point_px: [{}, {}]\n", blanks, camera.principal_point_px.x(),
                      camera.principal_point_px.y());
  const auto names = distortionNames(camera.model);
  const int count = distortionCount(camera);
  const std::string legend = fmt::format("{}", fmt::join(names.begin(), names.begin() + count, ", "));
  const auto& d = camera.distortion;
  const bool pinhole = !isSphereModel(camera.model);
  return text + fmt::format("{}distortion: [{}]{}\n", blanks, fmt::join(d.begin(), d.begin() + count, ", "),
                            pinhole ? "" : "  # " + legend);
}

}  // namespace evical
