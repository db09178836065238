#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr KnownModels kMetavisionModels{"Metavision", true, true, false};

// OpenCV FileStorage's matrix in JSON.
std::string metavisionMatrixText(const Eigen::MatrixXd& matrix) {
  return fmt::format(R"({{"type_id": "opencv-matrix", "rows": {}, "cols": {}, "dt": "d", "data": [{}]}})",
                     matrix.rows(), matrix.cols(), rowMajor(matrix));
}

std::string metavisionCameraText(const RigCamera& camera, ExportNotes& notes) {
  const CameraIntrinsics own = cameraFor(camera, kMetavisionModels, notes);
  const std::vector<double> d = distortionOf(own, 5);
  return fmt::format(
      "{{\n  \"n_kept_views\": {},\n  \"image_size\": [{}, {}],\n  \"camera_matrix\": {},\n"
      "  \"distortion_coefficients\": {},\n  \"overall_rms_reprojection_error\": {}\n}}\n",
      camera.fit.windows_used, own.resolution_px.width_px, own.resolution_px.height_px,
      metavisionMatrixText(cameraMatrix(own)),
      metavisionMatrixText(Eigen::Map<const Eigen::RowVectorXd>(d.data(), 5)),
      real(camera.fit.reprojection_rms_px));
}

}  // namespace

ExportedFiles exportMetavision(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  for (const RigCamera& camera : rig.cameras) {
    const std::filesystem::path folder = rig.cameras.size() > 1 ? camera.file_name : "";
    exported.files.push_back({folder / "intrinsics.json", metavisionCameraText(camera, exported.notes)});
  }
  std::vector<std::string> lines{
      "Intrinsics for Metavision SDK 4 and before: pinhole, distortion k1 k2 p1 p2 k3 as OpenCV's.",
      "These files contain neither poses nor time offsets."};
  lines.insert(lines.end(), exported.notes.begin(), exported.notes.end());
  exported.files.push_back({"README.txt", readMe(rig, lines)});
  return exported;
}

}  // namespace evical
