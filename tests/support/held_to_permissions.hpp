// Root held to the permissions of files, as users are: what is refused to a user can be tested by
// it.
#pragma once

#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>

namespace photile::test {

/// The calling thread cannot override permissions while this lives.
class HeldToPermissions {
 public:
  HeldToPermissions() {
    REQUIRE(::syscall(SYS_capget, &head_, before_) == 0);
    __user_cap_data_struct without[2] = {before_[0], before_[1]};
    without[0].effective &= ~(1u << CAP_DAC_OVERRIDE | 1u << CAP_DAC_READ_SEARCH);
    REQUIRE(::syscall(SYS_capset, &head_, without) == 0);
  }
  ~HeldToPermissions() { ::syscall(SYS_capset, &head_, before_); }
  HeldToPermissions(const HeldToPermissions&) = delete;
  HeldToPermissions& operator=(const HeldToPermissions&) = delete;

  /// Drops them for good in a process that then executes another program; users have nothing to
  /// lose.
  static void for_good() {
    ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
    ::prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
  }

 private:
  __user_cap_header_struct head_{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct before_[2] = {};
};

}  // namespace photile::test
