// The command line's backend as the renderer's.
#pragma once

#include "command_line.hpp"
#include "render/context.hpp"

namespace app {

inline render::Backend backend_of(DrawBackend backend) {
  switch (backend) {
    case DrawBackend::osmesa:
      return render::Backend::osmesa;
    case DrawBackend::egl:
      return render::Backend::egl;
    case DrawBackend::automatic:
      break;
  }
  return render::Backend::automatic;
}

}  // namespace app
