//! System calls of a child, by a seccomp filter: those of a computation that reads open files and writes new ones.
//!
//! A list of what is allowed, because what the kernel learns next year is then refused as well. Anything else fails with
//! `EPERM` as if the process had no right to it, so that a library that asks for more than it needs goes on without.

use std::collections::BTreeMap;
use std::io;

use libc::c_long;
use seccompiler::{
    BpfProgram, Error, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter,
    SeccompRule, TargetArch,
};

/// Allowed whatever the arguments. Opening files is landlock's to decide.
const ALLOWED: &[c_long] = &[
    // Open files, and new ones.
    libc::SYS_read,
    libc::SYS_readv,
    libc::SYS_pread64,
    libc::SYS_write,
    libc::SYS_writev,
    libc::SYS_lseek,
    libc::SYS_close,
    libc::SYS_fstat,
    libc::SYS_newfstatat,
    libc::SYS_statx,
    libc::SYS_openat,
    libc::SYS_fsync,
    libc::SYS_fdatasync,
    // Memory.
    libc::SYS_brk,
    libc::SYS_munmap,
    libc::SYS_mremap,
    libc::SYS_madvise,
    // Threads and their signals.
    libc::SYS_clone3,
    libc::SYS_futex,
    libc::SYS_set_robust_list,
    libc::SYS_rseq,
    libc::SYS_sched_yield,
    libc::SYS_sched_getaffinity,
    libc::SYS_rt_sigaction,
    libc::SYS_rt_sigprocmask,
    libc::SYS_rt_sigreturn,
    libc::SYS_sigaltstack,
    libc::SYS_gettid,
    libc::SYS_getpid,
    // These cannot fail, so nobody is ready for it.
    libc::SYS_getppid,
    libc::SYS_getuid,
    libc::SYS_geteuid,
    libc::SYS_getgid,
    libc::SYS_getegid,
    libc::SYS_restart_syscall,
    // Time, chance and the end.
    libc::SYS_clock_gettime,
    libc::SYS_clock_nanosleep,
    libc::SYS_nanosleep,
    libc::SYS_getrandom,
    libc::SYS_exit,
    libc::SYS_exit_group,
];

/// Confines this thread and those that it starts. Whether the kernel has filters.
pub(super) fn confine() -> io::Result<bool> {
    let Ok(arch) = TargetArch::try_from(std::env::consts::ARCH) else { return Ok(false) };
    // Its flags stand in memory, where a filter does not look: the C library asks for `clone` instead when it is told
    // that there is no such call. First, because the second filter does not let this one in.
    let no_clone3 = SeccompFilter::new(
        BTreeMap::from([(libc::SYS_clone3, vec![])]),
        SeccompAction::Allow,
        SeccompAction::Errno(libc::ENOSYS as u32),
        arch,
    );
    let allowed = SeccompFilter::new(
        allowed().map_err(io::Error::other)?,
        SeccompAction::Errno(libc::EPERM as u32),
        SeccompAction::Allow,
        arch,
    );
    for filter in [no_clone3, allowed] {
        let program = filter.and_then(BpfProgram::try_from).map_err(io::Error::other)?;
        match seccompiler::apply_filter(&program) {
            Ok(()) => {}
            Err(Error::Seccomp(error) | Error::Prctl(error)) if is_missing(&error) => return Ok(false),
            Err(error) => return Err(io::Error::other(error)),
        }
    }
    Ok(true)
}

/// The kernel, or the container around the server, has no filters.
fn is_missing(error: &io::Error) -> bool {
    matches!(error.raw_os_error(), Some(libc::ENOSYS | libc::EINVAL | libc::EPERM | libc::EACCES))
}

fn allowed() -> Result<BTreeMap<c_long, Vec<SeccompRule>>, seccompiler::BackendError> {
    let mut rules: BTreeMap<_, _> = ALLOWED.iter().map(|&call| (call, vec![])).collect();
    let own = u64::from(std::process::id());
    let only_if = |argument, op, value| {
        let condition = SeccompCondition::new(argument, SeccompCmpArgLen::Dword, op, value)?;
        Ok(vec![SeccompRule::new(vec![condition])?])
    };
    let without_execution = || only_if(2, SeccompCmpOp::MaskedEq(libc::PROT_EXEC as u64), 0);
    rules.insert(libc::SYS_mmap, without_execution()?);
    rules.insert(libc::SYS_mprotect, without_execution()?);
    // How the standard library looks whether a file is still open.
    rules.insert(libc::SYS_fcntl, only_if(1, SeccompCmpOp::Eq, libc::F_GETFD as u64)?);
    // A process may say what it does.
    rules.insert(libc::SYS_prctl, only_if(0, SeccompCmpOp::Eq, libc::PR_SET_NAME as u64)?);
    // Threads of this process, no further process.
    let thread = libc::CLONE_THREAD as u64;
    rules.insert(libc::SYS_clone, only_if(0, SeccompCmpOp::MaskedEq(thread), thread)?);
    // How a process aborts itself.
    rules.insert(libc::SYS_tgkill, only_if(0, SeccompCmpOp::Eq, own)?);
    // Limits may be asked for, not set: there is no new value.
    let no_value = SeccompCondition::new(2, SeccompCmpArgLen::Qword, SeccompCmpOp::Eq, 0)?;
    rules.insert(libc::SYS_prlimit64, vec![SeccompRule::new(vec![no_value])?]);
    Ok(rules)
}
