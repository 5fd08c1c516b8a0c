#include "simbody_bridge/library/physics_library.h"

#include <dlfcn.h>
#include <stdlib.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/library/entry.h"

namespace tcs {

namespace {

std::string library_path;

// A variable of the environment has another value for a while. Clients inherit the value that it
// then has once more.
class Meanwhile {
 public:
  Meanwhile(const char* name, const char* value) : name_(name) {
    if (const char* before = getenv(name)) before_ = before;
    setenv(name, value, 1);
  }
  ~Meanwhile() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Meanwhile(const Meanwhile&) = delete;
  Meanwhile& operator=(const Meanwhile&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

MakeDynamicsFunction* Load() {
  if (library_path.empty()) throw DynamicsError("nobody has said where the physics are");
  // OpenBLAS makes its threads when it is loaded: the coordinator has none that it does not know.
  const Meanwhile alone("OPENBLAS_NUM_THREADS", "1");
  void* library = dlopen(library_path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* entry = library == nullptr ? nullptr : dlsym(library, kMakeDynamicsName);
  if (entry != nullptr) return reinterpret_cast<MakeDynamicsFunction*>(entry);
  const char* why = dlerror();
  throw DynamicsError("the physics (libtcs_physics.so) cannot be loaded: " +
                      std::string(why == nullptr ? "no reason is known" : why) +
                      "; install tcs again");
}

}  // namespace

void SetPhysicsLibrary(std::string path) { library_path = std::move(path); }

std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world) {
  static MakeDynamicsFunction* const make = Load();
  return std::unique_ptr<Dynamics>(make(world));
}

}  // namespace tcs
