// startrack models: the database of known objects.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "firmware_like/model_from_mesh.hpp"
#include "firmware_like/model_meshes.hpp"
#include "hal/error.hpp"
#include "hal/models/ply_import.hpp"
#include "hal/results/line_file.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/model_picture.hpp"
#include "tools/startrack/out_file.hpp"
#include "tools/startrack/volume_file.hpp"

namespace st {
namespace {

struct Arguments {
  std::string database = "models.db", model, name, file, descriptors;
  OutFile out;
  double scale = 1;
  int version = 0;
};
using Action = int (*)(const Arguments&);

ModelStore open_existing(const std::string& path) {
  if (!std::filesystem::exists(path))
    throw Failure(ExitCode::kBadInput, path + ": there is no such database; a run with --models " + path +
                                           " makes it, and so does startrack models import");
  return ModelStore(path);
}

StoredModel wanted(ModelStore& store, const Arguments& a) {
  const auto model = store.find(a.model, a.version);
  if (!model)
    throw Failure(
        ExitCode::kBadInput,
        store.path() + ": has no model " + a.model +
            (a.version > 0 ? " with a stored version " + std::to_string(a.version) : std::string()) +
            "; startrack models list shows what there is");
  return *model;
}

int list(const Arguments& a) {
  ModelStore store = open_existing(a.database);
  std::printf("%-16s  %-20s %7s  %-20s  %-17s %8s %7s  %s\n", "id", "name", "version", "updated", "size (m)",
              "features", "KiB", "source");
  for (const ModelEntry& e : store.list())
    std::printf("%-16s  %-20s %7d  %-20s  %4.2f x %4.2f x %4.2f %7d %7lld  %s\n", e.id.c_str(),
                e.name.c_str(), e.version, e.updated.c_str(), e.width_m, e.depth_m, e.height_m, e.features,
                static_cast<long long>(e.bytes / 1024), e.source.c_str());
  return 0;
}

int show(const Arguments& a) {
  ModelStore store = open_existing(a.database);
  const StoredModel model = wanted(store, a);
  const std::string out = a.out.path.empty() ? model.entry.name + ".png" : a.out.path;
  a.out.check(out);
  const OwnedModel content = decode_model(model.content, model.entry.name);
  const ColorStats& color = content.traits.color;
  std::printf("name       %s\nid         %s\nversion    %d\ncreated    %s\n", model.entry.name.c_str(),
              model.entry.id.c_str(), model.entry.version, model.entry.created.c_str());
  std::printf("size       %.3f x %.3f x %.3f m\nvoxel      %.2f mm, %zu bricks, %u frames\n",
              model.entry.width_m, model.entry.depth_m, model.entry.height_m,
              static_cast<double>(content.volume.voxel_m) * 1e3, content.bricks.size(),
              content.traits.integrated);
  std::printf("colour     grey %.0f +- %.0f, red %.2f, green %.2f\nfeatures   %zu\n",
              static_cast<double>(color.luminance), static_cast<double>(color.luminance_sigma),
              static_cast<double>(color.red_share), static_cast<double>(color.green_share),
              content.features.size());
  for (const ModelVersion& v : store.history(model.entry.id))
    std::printf("version %-3d %s  startrack %s  %s%s\n", v.version, v.saved.c_str(), v.program.c_str(),
                v.source.c_str(), v.has_content ? "" : "  (content dropped)");
  ModelMeshes meshes;
  const MeshView mesh = mesh_of(content.view(), meshes);
  write_whole_file(out, model_picture(mesh, content.features));
  std::printf("picture: %s\n", out.c_str());
  return 0;
}

int import(const Arguments& a) {
  const Mesh mesh = import_ply(read_whole_file(a.file), a.scale, a.file);
  const OwnedModel model = model_from_mesh(mesh.view(), a.file);
  ModelStore store(a.database);
  ModelEntry entry = entry_of(model.view());
  entry.name = a.name.empty() ? std::filesystem::path(a.file).stem().string() : a.name;
  entry.source = a.file;
  entry.program = STARTRACK_VERSION;
  ModelContent content = encode_model(model.view());
  content.thumbnail = model_thumbnail(mesh.view());
  entry = store.add(entry, content);
  std::printf("%s  %s, %d features\n", entry.id.c_str(), entry.name.c_str(), entry.features);
  return 0;
}

int export_model(const Arguments& a) {
  ModelStore store = open_existing(a.database);
  const StoredModel model = wanted(store, a);
  const OwnedModel content = decode_model(model.content, model.entry.name);
  ModelMeshes meshes;
  const std::string out = a.out.path.empty() ? model.entry.name + ".ply" : a.out.path;
  a.out.check(out);
  write_whole_file(out, format_ply(mesh_of(content.view(), meshes)));
  std::printf("mesh: %s\n", out.c_str());
  return 0;
}

int rename(const Arguments& a) {
  ModelStore store = open_existing(a.database);
  store.rename(wanted(store, a).entry.id, a.name);
  return 0;
}

int erase(const Arguments& a) {
  ModelStore store = open_existing(a.database);
  store.erase(wanted(store, a).entry.id);
  return 0;
}

int merge(const Arguments& a) {
  ModelStore other = open_existing(a.file);
  ModelStore store(a.database);
  std::printf("%d models came over\n", store.merge(other));
  return 0;
}

int keypoints(const Arguments& a) {
  print_keypoints(a.file, a.descriptors);
  return 0;
}

CLI::App* add(CLI::App& models, const char* name, const char* what, const std::string& example,
              const std::shared_ptr<Arguments>& arguments, Action action, int& exit_code) {
  CLI::App* command = models.add_subcommand(name, what);
  command->footer("Example:\n  startrack models " + example);
  command->add_option("--models", arguments->database, "the database")
      ->type_name("DB")
      ->capture_default_str();
  command->callback([arguments, action, &exit_code] { exit_code = action(*arguments); });
  return command;
}

}  // namespace

void add_models(CLI::App& app, int& exit_code) {
  CLI::App* models =
      app.add_subcommand("models", "The database of known objects: list, show, import, export, ...");
  models->require_subcommand(1);
  models->footer("Runs use it with --models DB. Example:\n  startrack models list --models lab.db");
  auto a = std::make_shared<Arguments>();
  const auto model = [&](CLI::App* command) {
    command->add_option("MODEL", a->model, "its name or id")->required();
    return command;
  };
  add(*models, "list", "One line per model", "list --models lab.db", a, list, exit_code);
  CLI::App* c = model(add(*models, "show", "All about one model, and a picture of it with its keypoints",
                          "show create --out create.png", a, show, exit_code));
  a->out.add_options(*c, "the picture (default: MODEL.png)", "PNG");
  c->add_option("--version", a->version, "an older one (default: the newest)")->check(CLI::PositiveNumber);
  c = add(*models, "import", "A model from a mesh (PLY, metres, z up, standing on z = 0)",
          "import create.ply --name create", a, import, exit_code);
  c->add_option("PLY", a->file, "the mesh")->required();
  c->add_option("--name", a->name, "of the model (default: the file's)");
  c->add_option("--scale", a->scale, "metres per unit of the file")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  c = model(add(*models, "export", "A model as a mesh", "export create --out create.ply", a, export_model,
                exit_code));
  a->out.add_options(*c, "the mesh (default: MODEL.ply)", "PLY");
  c->add_option("--version", a->version, "an older one (default: the newest)")->check(CLI::PositiveNumber);
  c = model(
      add(*models, "rename", "Give a model another name", "rename object-1 create", a, rename, exit_code));
  c->add_option("NAME", a->name, "the new name")->required();
  model(add(*models, "delete", "Forget a model", "delete object-3", a, erase, exit_code));
  c = add(*models, "merge", "Take over what another database knows", "merge friday.db --models lab.db", a,
          merge, exit_code);
  c->add_option("OTHER", a->file,
                "the other database; it stays as it is, but for a migration where it is of an older kind")
      ->required();
  c = models->add_subcommand("keypoints", "3-D SIFT keypoints of a raw volume, as CSV");
  c->footer("Example:\n  startrack models keypoints volume.raw --descriptors volume.desc");
  c->add_option("VOLUME", a->file,
                "float32 values, little-endian, x fastest, then y, then z; 32, 64, 128 or 256 a side")
      ->required();
  c->add_option("--descriptors", a->descriptors, "also write them: 2,048 float32 per line of the CSV")
      ->type_name("FILE");
  c->callback([a, &exit_code] { exit_code = keypoints(*a); });
}

}  // namespace st
