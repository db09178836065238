#include "core/pipeline/session/import_session.h"

#include "core/base/file_places.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/format/intrinsics_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace evical {
namespace {

const char* programOf(ImportKind kind) {
  if (kind == ImportKind::EkalibrConfiguration) return "ekalibr";
  if (kind == ImportKind::LensFile) return "";
  return kind == ImportKind::Intrinsics ? "ros" : "kalibr";
}

void checkFrom(const ImportRequest& request, const std::vector<ImportSource>& sources) {
  if (request.from.empty()) return;
  const std::array<std::string, 3> known{"kalibr", "ekalibr", "ros"};
  if (std::find(known.begin(), known.end(), request.from) == known.end())
    throw badInput(howTo(HowTo::Option, {"from"}),
                   fmt::format("files of '{}' cannot be imported", request.from),
                   nameAdvice(request.from, known));
  for (const ImportSource& source : sources) {
    const bool lens = source.kind == ImportKind::Intrinsics;  // eKalibr's, ROS's or Evical's own
    if (request.from != programOf(source.kind) && !(lens && request.from == "ekalibr"))
      throw badInput(source.path.string(), fmt::format("is not a file of {}", request.from),
                     "Omit " + howTo(HowTo::Option, {"from"}));
  }
}

std::vector<ImportSource> readSources(const ImportRequest& request) {
  std::vector<ImportSource> sources;
  for (const std::filesystem::path& file : request.files) sources.push_back(recogniseSource(file));
  checkFrom(request, sources);
  return sources;
}

void setRecording(const ImportRequest& request, ImportedSession& imported) {
  Session& session = imported.session;
  if (!request.recording.empty()) session.recording = request.recording;
  if (session.recording.empty())
    throw badInput("recording", "none of the files names a recording",
                   "Give it with " + howTo(HowTo::Option, {"recording FILE"}));
  if (pathExists(session.recording)) return;
  if (!request.recording.empty())
    throw badInput(session.recording.string(), "does not exist",
                   "Check the path after " + howTo(HowTo::Option, {"recording"}));
  imported.notes.push_back(fmt::format("recording {} does not exist: give another one with {}",
                                       session.recording.string(), howTo(HowTo::Option, {"recording FILE"})));
}

bool intrinsicsAlone(const std::vector<ImportSource>& sources) {
  return std::all_of(sources.begin(), sources.end(), [](const ImportSource& source) {
    return source.kind == ImportKind::Intrinsics || source.kind == ImportKind::KalibrCamchain ||
           source.kind == ImportKind::LensFile;
  });
}

struct ImportedIntrinsics {
  std::string name;
  CameraIntrinsics intrinsics;
};

// Takes names from the file, if it has names that can be part of a path.
void addLenses(const LensFile& file, std::vector<ImportedIntrinsics>& cameras) {
  const std::vector<ReadCamera>& found = file.read.cameras;
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::string name = found[i].name;
    std::replace(name.begin(), name.end(), '/', '_');
    name.erase(0, std::min(name.find_first_not_of("_."), name.size()));
    if (name.empty()) name = found.size() > 1 ? fmt::format("cam{}", i) : file.read.path.stem().string();
    validateImported(*found[i].lens, fmt::format("{}: {}", file.read.path.string(), name));
    cameras.push_back({name, *found[i].lens});
  }
}

// Adds notes on contents other than the lens, which are not imported.
void noteLeftOut(const LensFile& file, std::vector<std::string>& notes) {
  const std::string name = file.read.path.filename().string();
  const auto any = [&](const auto& has) {
    return std::any_of(file.read.cameras.begin(), file.read.cameras.end(), has);
  };
  std::vector<std::string> left_out;
  if (any([](const ReadCamera& camera) { return camera.frame_from_camera.has_value(); }))
    left_out.emplace_back("poses");
  if (any([](const ReadCamera& camera) { return camera.time_offset_s.has_value(); }))
    left_out.emplace_back("time offsets");
  if (!file.read.imus.empty()) left_out.emplace_back("IMU parameters");
  notes.push_back(fmt::format("{}: read as {}", name, file.layout));
  if (!left_out.empty())
    notes.push_back(fmt::format("{}: {} are not imported and will be estimated", name, joined(left_out)));
}

std::vector<ImportedIntrinsics> intrinsicsOf(const std::vector<ImportSource>& sources) {
  std::vector<ImportedIntrinsics> cameras;
  for (const ImportSource& source : sources) {
    if (source.kind == ImportKind::LensFile) {
      addLenses(*source.lenses, cameras);
    } else if (source.kind == ImportKind::Intrinsics) {
      const std::string name = source.path.stem().string();
      const auto of_oak = oakCameras(source.root);
      for (const auto& [socket, camera] : of_oak) cameras.push_back({socket, readIntrinsics(camera)});
      if (of_oak.empty()) cameras.push_back({name, readIntrinsicsFile(source.path, name, "")});
      if (of_oak.empty()) validateImported(cameras.back().intrinsics, source.path.string());
    } else {
      for (const std::string& key : camchainCameras(source.root))
        cameras.push_back({key, readIntrinsics(source.root[key])});
    }
  }
  return cameras;
}

// Notes on other contents of a camchain: these are estimates, and do not become priors automatically.
void notePriors(const std::vector<ImportSource>& sources, std::vector<std::string>& notes) {
  for (const ImportSource& source : sources) {
    if (source.kind == ImportKind::LensFile) noteLeftOut(*source.lenses, notes);
    if (source.kind == ImportKind::Intrinsics) {
      for (const std::string& note : leftOutOf(source.root))
        notes.push_back(fmt::format("{}: {}", source.path.filename().string(), note));
      const auto of_oak = oakCameras(source.root);
      for (const auto& [socket, camera] : of_oak)
        for (const std::string& note : leftOutOf(camera))
          notes.push_back(fmt::format("{}: {}", socket, note));
      if (!of_oak.empty() && of_oak.size() < source.root["cameraData"].items().size())
        notes.push_back(
            fmt::format("{}: cameras without intrinsics are left out", source.path.filename().string()));
    }
    if (source.kind != ImportKind::KalibrCamchain) continue;
    const std::vector<std::string> cameras = camchainCameras(source.root);
    for (const std::string& key : source.root.keys()) {
      if (std::find(cameras.begin(), cameras.end(), key) == cameras.end()) {
        notes.push_back(fmt::format("{} is ignored: it is not a camera", key));
        continue;
      }
      for (const std::string& note : leftOutOf(source.root[key]))
        notes.push_back(fmt::format("{}: {}", key, note));
      if (source.root[key].has("T_cam_imu") || source.root[key].has("T_cn_cnm1"))
        notes.push_back(
            fmt::format("{}: its pose and time offset are not imported and will be estimated; to fix them, "
                        "give them under prior",
                        key));
    }
  }
}

// Square pixels have nearly the same focal lengths. Numbers in the order fx cx fy cy do not.
void noteOblongPixels(const std::string& name, const CameraIntrinsics& camera,
                      std::vector<std::string>& notes) {
  constexpr double kMax = 1.3;
  const double factor = camera.focal_length_px.maxCoeff() / camera.focal_length_px.minCoeff();
  if (factor > kMax)
    notes.push_back(fmt::format(
        "{}: fx and fy differ by a factor of {:.1f}: check the order of the numbers (fx fy cx cy)", name,
        factor));
}

ImportedFiles importIntrinsics(const std::vector<ImportSource>& sources,
                               const std::filesystem::path& output) {
  const std::vector<ImportedIntrinsics> cameras = intrinsicsOf(sources);
  ImportedFiles imported;
  for (const ImportedIntrinsics& camera : cameras) {
    std::filesystem::path path = output;
    if (cameras.size() > 1)
      path.replace_filename(
          fmt::format("{}-{}{}", output.stem().string(), camera.name, output.extension().string()));
    for (const FileContent& other : imported.files)
      if (other.path == path)
        throw badInput(camera.name, "is the name of two cameras", "Import the files one by one");
    imported.files.push_back({path, intrinsicsYaml(camera.intrinsics, 0)});
    noteOblongPixels(camera.name, camera.intrinsics, imported.notes);
  }
  notePriors(sources, imported.notes);
  return imported;
}

ImportedSession sessionOf(const std::vector<ImportSource>& sources, const ImportRequest& request) {
  ImportedSession imported;
  const auto configuration = std::find_if(sources.begin(), sources.end(), [](const ImportSource& source) {
    return source.kind == ImportKind::EkalibrConfiguration;
  });
  if (configuration != sources.end()) {
    if (sources.size() > 1)
      throw badInput(configuration->path.string(),
                     "is a complete eKalibr configuration, but further files are given",
                     "Import it alone: it names its intrinsics files");
    importEkalibr(*configuration, request, imported);
  } else {
    importKalibr(sources, request, imported);
    notePriors(sources, imported.notes);
  }
  setRecording(request, imported);
  Session& session = imported.session;
  for (const SessionCamera& camera : session.cameras)
    if (camera.intrinsics) noteOblongPixels(camera.name, *camera.intrinsics, imported.notes);
  if (request.radius_m) session.board.radius_m = *request.radius_m;
  validate(session.board);
  if (session.reference.empty())
    session.reference = session.imus.empty() ? session.cameras.at(0).name : session.imus[0].name;
  validate(session, "import");
  return imported;
}

}  // namespace

ImportedSession importSession(const ImportRequest& request) {
  return sessionOf(readSources(request), request);
}

ImportedFiles importFiles(const ImportRequest& request, const std::filesystem::path& output) {
  std::error_code ignored;
  for (const std::filesystem::path& file : request.files)
    if (std::filesystem::equivalent(file, output, ignored))
      throw badInput(output.string(), "input and output are the same", "Choose another output");
  const std::vector<ImportSource> sources = readSources(request);
  if (intrinsicsAlone(sources)) return importIntrinsics(sources, output);
  const ImportedSession imported = sessionOf(sources, request);
  const auto folder = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
  return {{{output, sessionYaml(imported.session, folder)}}, imported.notes};
}

ImportSource recogniseSource(const std::filesystem::path& path) {
  if (auto lenses = readLensFile(path))
    return {path, YamlNode::parse("{}", path.string()), ImportKind::LensFile, std::move(lenses)};
  const YamlNode root = loadIntrinsics(path);
  const auto as = [&](ImportKind kind) { return ImportSource{path, root, kind}; };
  if (root.isMap()) {
    if (root.has("Configor")) return as(ImportKind::EkalibrConfiguration);
    if (root.has("target_type")) return as(ImportKind::KalibrTarget);
    if (!camchainCameras(root).empty()) return as(ImportKind::KalibrCamchain);
    if (root.has("imu0") || root.has("accelerometer_noise_density")) return as(ImportKind::KalibrImu);
    if (isLens(root)) return as(ImportKind::Intrinsics);
  }
  throw root.error(
      root.isMap() && root.has("evical_session") ? "is already a session"
                                                 : "has no layout that can be imported",
      "Give an eKalibr configuration; Kalibr's target, imu and camchain files; or intrinsics of " +
          lensLayouts());
}

std::string sensorName(const std::string& topic, bool imu, const Session& session) {
  // "/a/b/events" -> {a, b}: the last part is the type of the messages.
  std::vector<std::string> parts(1);
  for (const char letter : topic) {
    if (letter != '/') {
      parts.back() += letter;
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.back().empty() && parts.size() > 1) parts.pop_back();
  if (parts.size() > 1) parts.pop_back();
  std::string name;
  for (const std::string& part : parts) name += (name.empty() ? "" : "_") + part;
  if (imu) name += "_imu";
  if (name.empty()) name = "camera";
  std::string unique = name;
  for (int number = 2; isSensorName(session, unique); ++number) unique = fmt::format("{}_{}", name, number);
  return unique;
}

}  // namespace evical
