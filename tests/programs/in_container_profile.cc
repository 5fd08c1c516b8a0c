// in_container_profile COMMAND...: executes it with the system calls refused that Docker refuses to
// all containers without further capabilities: its default seccomp profile
// (profiles/seccomp/default.json of moby, 2022) turned round for this architecture. As there,
// clone3 is unknown, and whoever asks for another personality or for namespaces may not.
#include <errno.h>
#include <linux/audit.h>
#include <stddef.h>

#include <iterator>

#include "tests/programs/seccomp_filter.h"

using namespace seccomp_filter;

namespace {

constexpr unsigned kRefused[] = {
    // Of CAP_SYS_PTRACE.
    SYS_kcmp, SYS_pidfd_getfd, SYS_process_madvise,
    // Of CAP_SYS_ADMIN.
    SYS_bpf, SYS_fanotify_init, SYS_fsconfig, SYS_fsmount, SYS_fsopen, SYS_fspick,
    SYS_lookup_dcookie, SYS_mount, SYS_mount_setattr, SYS_move_mount, SYS_open_tree,
    SYS_perf_event_open, SYS_quotactl, SYS_quotactl_fd, SYS_setdomainname, SYS_sethostname,
    SYS_setns, SYS_syslog, SYS_umount2, SYS_unshare,
    // Of others.
    SYS_acct, SYS_chroot, SYS_clock_settime, SYS_delete_module, SYS_finit_module, SYS_get_mempolicy,
    SYS_init_module, SYS_ioperm, SYS_iopl, SYS_mbind, SYS_open_by_handle_at, SYS_reboot,
    SYS_set_mempolicy, SYS_set_mempolicy_home_node, SYS_settimeofday, SYS_vhangup,
    // Of nobody.
    SYS_add_key, SYS_kexec_file_load, SYS_kexec_load, SYS_keyctl, SYS_migrate_pages, SYS_move_pages,
    SYS_pivot_root, SYS_request_key, SYS_swapoff, SYS_swapon, SYS_sysfs, SYS_userfaultfd,
    SYS_ustat};
constexpr unsigned kPersonalities[] = {0, 0x8, 0x20000, 0x20008, 0xffffffff};
constexpr unsigned kNamespaces = 0x7e020000;  // of clone's flags

std::vector<sock_filter> Profile() {
  const sock_filter allow = Return(SECCOMP_RET_ALLOW);
  const sock_filter refuse = Return(SECCOMP_RET_ERRNO | EPERM);
  const sock_filter first = Load(offsetof(seccomp_data, args));
  std::vector<sock_filter> code{Load(offsetof(seccomp_data, arch)),
                                Jump(BPF_JEQ, AUDIT_ARCH_X86_64, 1, 0),
                                allow,
                                Load(offsetof(seccomp_data, nr)),
                                Jump(BPF_JEQ, SYS_clone3, 0, 1),
                                Return(SECCOMP_RET_ERRNO | ENOSYS),
                                Jump(BPF_JEQ, SYS_clone, 0, 4),
                                first,
                                Jump(BPF_JSET, kNamespaces, 0, 1),
                                refuse,
                                allow,
                                Jump(BPF_JEQ, SYS_personality, 0, std::size(kPersonalities) + 3),
                                first};
  for (std::size_t i = 0; i < std::size(kPersonalities); ++i) {
    code.push_back(Jump(BPF_JEQ, kPersonalities[i], std::size(kPersonalities) - i, 0));
  }
  code.push_back(refuse);
  code.push_back(allow);
  for (const unsigned number : kRefused) {
    code.push_back(Jump(BPF_JEQ, number, 0, 1));
    code.push_back(refuse);
  }
  code.push_back(allow);
  return code;
}

bool RefusesDuplicates() { return syscall(SYS_pidfd_getfd, -1, 0, 0) == -1 && errno == EPERM; }

}  // namespace

int main(int, char** argv) { return ExecuteBehind(Profile(), RefusesDuplicates, argv); }
