//! Windows: job objects and exit codes.

use std::fs::File;
use std::io::{self, Write};
use std::os::windows::io::{AsHandle, AsRawHandle, FromRawHandle, OwnedHandle};
use std::os::windows::process::CommandExt;
use std::process::{self, Child, Command, ExitStatus};
use std::ptr::null;
use std::thread;
use windows_sys::Win32::Foundation::STATUS_ACCESS_VIOLATION;
use windows_sys::Win32::System::JobObjects::{
    AssignProcessToJobObject, CreateJobObjectW, JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE,
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION, JobObjectExtendedLimitInformation,
    SetInformationJobObject, TerminateJobObject,
};
use windows_sys::Win32::System::ProcessStatus::{K32GetProcessMemoryInfo, PROCESS_MEMORY_COUNTERS};
use windows_sys::Win32::System::Threading::CREATE_NEW_PROCESS_GROUP;
use windows_sys::core::BOOL;

/// Keeps Ctrl-C at the terminal away from the program.
pub fn separate(command: &mut Command) -> &mut Command {
    command.creation_flags(CREATE_NEW_PROCESS_GROUP)
}

/// A program and all the processes that it starts. They end when this is dropped.
#[derive(Debug)]
pub struct ProcessGroup(Option<OwnedHandle>);

impl ProcessGroup {
    /// Starts a program in a job object of its own.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(command: &mut Command) -> io::Result<(Child, Self)> {
        let job = job()?;
        let mut child = separate(command).spawn()?;
        // A process that the program starts before this call is not in the job.
        // SAFETY: both handles are open.
        let assigned =
            unsafe { AssignProcessToJobObject(job.as_raw_handle(), child.as_raw_handle()) };
        if let Err(error) = checked(assigned) {
            // The process might have ended already.
            let _ = child.kill();
            let _ = child.wait();
            return Err(error);
        }
        Ok((child, Self(Some(job))))
    }

    /// Starts a worker without a job object: its keeper, which outlives it, would be in the job.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start_worker(command: &mut Command) -> io::Result<(Child, Self)> {
        Ok((separate(command).spawn()?, Self(None)))
    }

    /// Asks the processes to end. Returns true if the system has a way to ask.
    pub fn ask(&self) -> bool {
        false
    }

    /// Kills the processes.
    pub fn kill(&self) {
        if let Some(job) = &self.0 {
            // SAFETY: the handle is open. Terminating a job without processes does nothing.
            unsafe { TerminateJobObject(job.as_raw_handle(), 1) };
        }
    }
}

/// The parent of this process.
#[derive(Debug)]
pub struct Parent;

impl Parent {
    /// Returns the parent at this moment.
    pub fn now() -> Self {
        Self
    }

    /// Returns false: the system does not tell.
    pub fn has_ended(&self) -> bool {
        false
    }
}

/// Ends this process.
pub fn end_group() -> ! {
    process::exit(0)
}

/// Does nothing: files have no limit that ends a process.
pub fn report_large_files() {}

/// Waits forever: the system has no way to wait without reading.
pub fn wait_for_end_of_input() {
    loop {
        thread::park();
    }
}

/// Does nothing: a job object ends a program.
pub fn end_with_thread(_: &mut Command) {}

/// Ends this process as another one ended.
pub fn end_like(status: ExitStatus) -> ! {
    process::exit(status.code().unwrap_or(1))
}

/// Returns a new job object, whose processes end with its last handle.
fn job() -> io::Result<OwnedHandle> {
    // SAFETY: attributes and a name are optional.
    let handle = unsafe { CreateJobObjectW(null(), null()) };
    if handle.is_null() {
        return Err(io::Error::last_os_error());
    }
    // SAFETY: the handle is new and has no other owner.
    let job = unsafe { OwnedHandle::from_raw_handle(handle) };
    let mut limits = JOBOBJECT_EXTENDED_LIMIT_INFORMATION::default();
    limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
    // SAFETY: the handle is open; the class has this structure, whose size is passed.
    let limited = unsafe {
        SetInformationJobObject(
            job.as_raw_handle(),
            JobObjectExtendedLimitInformation,
            (&raw const limits).cast(),
            size_of_val(&limits) as u32,
        )
    };
    checked(limited)?;
    Ok(job)
}

fn checked(done: BOOL) -> io::Result<()> {
    if done == 0 {
        Err(io::Error::last_os_error())
    } else {
        Ok(())
    }
}

/// Returns `None`: no signal ends a process. Its exit code names the exception.
pub fn signal(_: ExitStatus) -> Option<i32> {
    None
}

/// Returns the bytes of memory that a process uses, resident and swapped; `None` if the system does not
/// report it.
pub fn memory(child: &Child) -> Option<u64> {
    let mut counters = PROCESS_MEMORY_COUNTERS::default();
    let size = size_of_val(&counters) as u32;
    // SAFETY: the handle is open, and the structure has the size that is passed.
    let done = unsafe { K32GetProcessMemoryInfo(child.as_raw_handle(), &raw mut counters, size) };
    checked(done).ok()?;
    u64::try_from(counters.PagefileUsage).ok()
}

/// Writes to standard output. The standard library converts the text for a console.
///
/// # Errors
/// If a write fails.
pub fn write_output(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)?;
    out.flush()
}

/// Returns standard output for use by the caller alone; all other output goes to standard error.
///
/// # Errors
/// If the system refuses a handle.
pub fn private_output() -> io::Result<File> {
    let private = io::stdout().as_handle().try_clone_to_owned()?;
    // The C runtime, which drivers print with, also sets the handle that the standard library uses.
    // SAFETY: descriptors are numbers; the runtime refuses one that is not open.
    if unsafe { libc::dup2(2, 1) } == -1 {
        return Err(io::Error::last_os_error());
    }
    Ok(File::from(private))
}

/// Runs another program in place of this process, and ends with its exit code; returns only if it cannot be
/// started.
pub fn replace(command: &mut Command) -> io::Error {
    match command.status() {
        Ok(status) => process::exit(status.code().unwrap_or(1)),
        Err(error) => error,
    }
}

/// Ends this process as an access to invalid memory does.
pub fn crash() -> ! {
    process::exit(STATUS_ACCESS_VIOLATION)
}
