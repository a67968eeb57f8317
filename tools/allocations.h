#pragma once
// How often memory was asked for through operator new since the program started.

namespace ergon {

long allocations();

}  // namespace ergon
