// SPDX-License-Identifier: Apache-2.0
// The rows of ExportForms(), apart from the functions that look for them.
#include <fmt/format.h>

#include "lf/core/shell_word.h"
#include "lf/import/exports/export_forms.h"
#include "lf/import/exports/read_bundler.h"
#include "lf/import/exports/read_google_models.h"
#include "lf/import/exports/read_kapture.h"
#include "lf/import/exports/read_meshroom.h"
#include "lf/import/exports/read_metashape.h"
#include "lf/import/exports/read_mvsnet.h"
#include "lf/import/exports/read_nerfies.h"
#include "lf/import/exports/read_nsvf.h"
#include "lf/import/exports/read_nvm.h"
#include "lf/import/exports/read_openmvg.h"
#include "lf/import/exports/read_opensfm.h"
#include "lf/import/exports/read_polycam.h"
#include "lf/import/exports/read_reality_csv.h"
#include "lf/import/exports/read_reality_xmp.h"
#include "lf/import/exports/read_record3d.h"
#include "lf/import/exports/read_splat_cameras.h"
#include "lf/import/exports/read_tum.h"

namespace lf {
namespace {

// Returns the command that saves the largest of several arrays as NAME.npy, which holds the views
// in every file of this kind that we know.
//   modules  that Python imports
//   arrays   a Python expression for the arrays of the file sys.argv[1]
std::string SaveLargest(const std::filesystem::path& file, std::string_view modules,
                        std::string_view arrays) {
  return ShellCommand({"python3", "-c",
                       fmt::format("import sys, {}; numpy.save(sys.argv[2], max({}, key=lambda a: "
                                   "a.size))",
                                   modules, arrays),
                       FileArgument(file),
                       FileArgument(std::filesystem::path(file).replace_extension(".npy"))});
}

std::string SaveNpz(const std::filesystem::path& file) {
  return SaveLargest(file, "numpy", "numpy.load(sys.argv[1]).values()");
}

std::string SaveMatlab(const std::filesystem::path& file) {
  return SaveLargest(file, "numpy, scipy.io",
                     "(numpy.ascontiguousarray(a) for a in scipy.io.loadmat(sys.argv[1]).values() "
                     "if isinstance(a, numpy.ndarray))");
}

// Matlab's first index runs fastest, so that h5py sees the axes in the opposite order.
std::string SaveMatlabHdf5(const std::filesystem::path& file) {
  return SaveLargest(file, "h5py, numpy",
                     "(numpy.ascontiguousarray(a[...].T) for a in h5py.File(sys.argv[1]).values() "
                     "if isinstance(a, h5py.Dataset))");
}

// Adds the rows of forms that are read. A form whose files may lie beside those of another one,
// from which they were made, comes after it.
void AddFormsThatAreRead(std::vector<ExportForm>* forms) {
  forms->push_back({
      .name = "a reconstruction of OpenSfM or OpenDroneMap",
      .listed = "reconstruction.json (OpenSfM, OpenDroneMap)",
      .places = {"reconstruction.json", "opensfm/reconstruction.json"},
      .names = {"*.json"},
      .words = {"\"cameras\"", "\"shots\""},
      .read = ReadOpenSfm,
  });
  forms->push_back({
      .name = "a scene of Meshroom (AliceVision)",
      .listed = "cameras.sfm or sfm.json (Meshroom)",
      .places = {"cameras.sfm", "sfm.json", "sfm.sfm", "*.sfm",
                 "MeshroomCache/StructureFromMotion/*/cameras.sfm",
                 "StructureFromMotion/*/cameras.sfm"},
      .names = {"*.json"},
      .words = {"\"version\"", "\"views\"", "\"viewId\""},
      .read = ReadMeshroom,
  });
  forms->push_back({
      .name = "a scene of OpenMVG",
      .listed = "sfm_data.json (OpenMVG)",
      .places = {"sfm_data.json", "sfm_data_expanded.json", "reconstruction/sfm_data.json",
                 "*/sfm_data.json"},
      .names = {"*.json"},
      .words = {"\"sfm_data_version\"", "\"ptr_wrapper\""},
      .read = ReadOpenMvg,
  });
  forms->push_back({
      .name = "a bundle file (Bundler)",
      .listed = "bundle.out with list.txt (Bundler)",
      .places = {"bundle.out", "bundle/bundle.out", "*.out"},
      .words = {"# Bundle file v0.3"},
      .read = ReadBundler,
  });
  forms->push_back({
      .name = "a model of VisualSFM",
      .listed = "NAME.nvm (VisualSFM)",
      .places = {"*.nvm"},
      .words = {"NVM_V3"},
      .read = ReadNvm,
  });
  forms->push_back({
      .name = "the cameras of a 3D Gaussian splatting program",
      .listed = "cameras.json (3D Gaussian splatting)",
      .places = {"cameras.json"},
      .names = {"*.json"},
      .words = {"\"img_name\"", "\"rotation\"", "\"position\"", "\"fx\""},
      .read = ReadSplatLightField,
  });
  forms->push_back({
      .name = "a data set of MVSNet",
      .listed = "cams/*_cam.txt (MVSNet)",
      .places = {"cams/*_cam.txt", "*_cam.txt"},
      .words = {"extrinsic", "intrinsic"},
      .has_parts = true,
      .read = ReadMvsnet,
  });
  forms->push_back({
      .name = "a data set of nerfies",
      .listed = "camera/*.json (nerfies)",
      .places = {"camera/*.json"},
      .words = {"\"orientation\"", "\"position\"", "\"principal_point\"", "\"image_size\""},
      .has_parts = true,
      .read = ReadNerfies,
  });
  forms->push_back({
      .name = "the cameras of a chunk of Metashape",
      .listed = "cameras.xml (Metashape)",
      .places = {"*.xml"},
      .words = {"<document", "<chunk", "<sensors"},
      .read = ReadMetashape,
  });
  forms->push_back({
      .name = "camera parameters of RealityCapture or RealityScan",
      .listed = "NAME.csv (RealityCapture, RealityScan)",
      .places = {"*.csv"},
      .words = {"name,", "pitch", "roll", "k1"},
      .read = ReadRealityCsv,
  });
  forms->push_back({
      .name = "camera parameters of RealityCapture or RealityScan in OpenCV's conventions",
      .listed = "NAME.csv for OpenCV (RealityScan)",
      .places = {"*.csv"},
      .words = {"name,", "R00", "f_pix"},
      .read = ReadRealityCsv,
  });
  forms->push_back({
      .name = "XMP files of RealityCapture or RealityScan",
      .listed = "NAME.xmp beside the images (RealityCapture, RealityScan)",
      .places = {"*.xmp", "images/*.xmp"},
      .words = {"http://www.capturingreality.com/ns/xcr"},
      .has_parts = true,
      .read = ReadRealityXmp,
  });
  forms->push_back({
      .name = "a recording of Record3D",
      .listed = "metadata or metadata.json (Record3D)",
      .places = {"metadata", "metadata.json", "EXR_RGBD/metadata.json"},
      .words = {"\"poses\"", "\"K\""},
      .read = ReadRecord3d,
  });
  forms->push_back({
      .name = "raw data of Polycam",
      .listed = "keyframes/corrected_cameras/*.json (Polycam)",
      .places = {"keyframes/corrected_cameras/*.json", "corrected_cameras/*.json",
                 "keyframes/cameras/*.json", "cameras/*.json"},
      .words = {"\"t_00\"", "\"t_23\""},
      .has_parts = true,
      .read = ReadPolycam,
  });
  forms->push_back({
      .name = "a data set in the form of Google's Spaces",
      .listed = "models.json (Google's Spaces and Immersive Light Field Video)",
      .places = {"models.json"},
      .words = {"\"orientation\"", "\"principal_point\"", "\"focal_length\""},
      .read = ReadGoogleModels,
  });
  forms->push_back({
      .name = "a data set of kapture",
      .listed = "sensors/sensors.txt (kapture)",
      .places = {"sensors/sensors.txt", "sensors.txt"},
      .names = {"records_camera.txt", "trajectories.txt", "rigs.txt"},
      .words = {"kapture format"},
      .read = ReadKapture,
  });
}

// Adds the rows of forms whose names alone tell them.
void AddFormsOfTexts(std::vector<ExportForm>* forms) {
  forms->push_back({
      .name = "a data set of NSVF",
      .listed = "pose/*.txt with intrinsics.txt (NSVF)",
      .places = {"pose/*.txt"},
      .beside = "../intrinsics.txt",
      .has_parts = true,
      .read = ReadNsvf,
  });
  forms->push_back({
      .name = "a trajectory in the form of TUM's benchmark",
      .listed = "groundtruth.txt with rgb.txt (TUM)",
      .places = {"groundtruth.txt", "CameraTrajectory.txt", "KeyFrameTrajectory.txt"},
      .beside = "rgb.txt",
      .takes_focal = true,
      .read = ReadTum,
  });
}

// Adds the rows of forms that are not read. Each advice ends a message, and leads to a form that is
// read.
void AddFormsThatAreNotRead(std::vector<ExportForm>* forms) {
  forms->push_back({
      .name = "a recording of Record3D, which is an archive that is not looked into",
      .places = {"*.r3d"},
      .has_poses = true,
      .advice = "unpack it like a zip file, and give the folder with the file metadata",
  });
  forms->push_back({
      .name = "a photograph of a Lytro camera, which is decoded by other programs",
      .places = {"*.lfr"},
      .has_poses = true,
      .advice = "decode it by plenopticam, or by LFToolbox for Matlab, and give the folder of the "
                "views that they write",
  });
  // Packages of lfpreprocessor have names of this kind.
  forms->push_back({
      .name = "a raw photograph of a Lytro camera, which is decoded by other programs",
      .places = {"*.lfp"},
      .words = {"\x89LFP\r\n\x1A\n"},
      .has_poses = true,
      .advice = "decode it by plenopticam, or by LFToolbox for Matlab, and give the folder of the "
                "views that they write",
  });
  forms->push_back({
      .name = "a project of Metashape, which is read only by Metashape itself",
      .places = {"*.psx", "*.psz"},
      .has_poses = true,
      .advice = "open it in Metashape and save the cameras by File > Export > Export Cameras as "
                "Agisoft XML, or as Bundler",
  });
  forms->push_back({
      .name = "a project of RealityCapture or RealityScan, which is read only by these programs",
      .places = {"*.rcproj", "*.rsproj"},
      .has_poses = true,
      .advice = "open it there, and save the cameras by Registration (in RealityScan: Export "
                "Registration), in the section Export of the tab ALIGNMENT, as Bundler, COLMAP or "
                "internal and external camera parameters (CSV), or by Metadata (XMP) beside it",
  });
  forms->push_back({
      .name = "a project of Meshroom, which leads to the cameras but does not hold them",
      .places = {"*.mg"},
      .has_poses = true,
      .advice = "compute its StructureFromMotion node, and give the cameras.sfm in "
                "MeshroomCache/StructureFromMotion",
  });
  forms->push_back({
      .name = "a scene of AliceVision in Alembic's form, which is not read",
      .places = {"*.abc", "MeshroomCache/StructureFromMotion/*/sfm.abc"},
      .has_poses = true,
      .advice = "convert it by Meshroom's node ConvertSfMFormat to sfm, or give the cameras.sfm "
                "beside it",
  });
  forms->push_back({
      .name = "a scene of OpenMVG in its binary form, which is not read",
      .places = {"sfm_data.bin", "reconstruction/sfm_data.bin", "*/sfm_data.bin"},
      .has_poses = true,
      .advice = "convert it: openMVG_main_ConvertSfM_DataFormat -i sfm_data.bin -o sfm_data.json "
                "-V -I -E",
  });
  forms->push_back({
      .name = "the cameras of NeuS or IDR as an array, which is not read",
      .places = {"cameras_sphere.npz", "cameras.npz"},
      .has_poses = true,
      .advice = "write a transforms.json, whose poses and intrinsics are the factors of the "
                "matrices world_mat (OpenCV: decomposeProjectionMatrix)",
  });
  forms->push_back({
      .name = "a database of COLMAP, which holds features but no poses",
      .places = {"database.db"},
      .has_poses = true,
      .advice = "let COLMAP reconstruct the poses from it (colmap mapper), and give the folder of "
                "sparse/0 and images",
  });
  forms->push_back({
      .name = "a scene of Blender, which is read only by Blender itself",
      .places = {"*.blend"},
      .has_poses = true,
      .advice = "let the add-on of lfrendertools photograph it (doc/blender.md)",
  });
  forms->push_back({
      .name = "a scene of USD, which holds no photographs with their poses",
      .places = {"*.usdz", "*.usd", "*.usda", "*.usdc"},
      .advice = "export the photographs and their cameras from the program that made it",
  });
  forms->push_back({
      .name = "an HDF5 file",
      .places = {"*.h5", "*.hdf5"},
      .words = {"\x89HDF\r\n\x1A\n"},
      .advice = "give its path if it holds the views of a grid of cameras",
  });
  forms->push_back({
      .name = "a file of Matlab 7.3, which is not read",
      .places = {"*.mat"},
      .words = {"MATLAB 7.3 MAT-file"},
      .advice = "if one of its arrays holds the views of a grid of cameras, save it as a file of "
                "NumPy by h5py, and give that",
      .command = SaveMatlabHdf5,
  });
  forms->push_back({
      .name = "a file of Matlab, which is not read",
      .places = {"*.mat"},
      .advice = "if one of its arrays holds the views of a grid of cameras, save it as a file of "
                "NumPy by SciPy, and give that",
      .command = SaveMatlab,
  });
  forms->push_back({
      .name = "an archive of arrays of NumPy, which is not read",
      .places = {"*.npz"},
      .advice = "if one of them holds the views of a grid of cameras, save it as a file of its "
                "own, and give that",
      .command = SaveNpz,
  });
  forms->push_back({
      .name = "a point cloud or a splat model, which holds no photographs with their poses",
      .places = {"*.ply", "*.splat", "*.spz", "*.ksplat"},
      .advice = "give the folder of the photographs and of the poses from which it was made, such "
                "as the cameras.json that programs of 3D Gaussian splatting write beside it",
  });
  forms->push_back({
      .name = "an archive, which is not looked into",
      .places = {"*.zip", "*.tar", "*.tar.gz", "*.tgz", "*.7z"},
      .advice = "unpack it, and give the folder",
  });
}

}  // namespace

std::span<const ExportForm> ExportForms() {
  static const std::vector<ExportForm> forms = [] {
    std::vector<ExportForm> rows;
    AddFormsThatAreRead(&rows);
    AddFormsOfTexts(&rows);
    AddFormsThatAreNotRead(&rows);
    return rows;
  }();
  return forms;
}

}  // namespace lf
