#pragma once
// How often memory was asked for through operator new since the test program started.

namespace ergon::testing {

long allocations();

}  // namespace ergon::testing
