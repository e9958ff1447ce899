// The two contracts for programmer errors: never for input data, which is answered with an Error.
// Both stay on in every build: a benchmark that runs on after a broken invariant measures nothing.
#pragma once

namespace corridor::detail {

// Prints "file:line: contract broken: text" to stderr and aborts.
[[noreturn]] void contract_broken(const char* file, int line, const char* text);

}  // namespace corridor::detail

// What the caller must guarantee.
#define CORRIDOR_EXPECT(condition) \
  ((condition) ? void(0) : ::corridor::detail::contract_broken(__FILE__, __LINE__, #condition))

// What the callee guarantees.
#define CORRIDOR_ENSURE(condition) \
  ((condition) ? void(0) : ::corridor::detail::contract_broken(__FILE__, __LINE__, #condition))
