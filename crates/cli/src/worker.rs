//! `etalon worker`, the child process: it opens one backend, or lists the devices of a backend.

use crate::failure::Failure;
use clap::Args;
use etalon_adapters::{BackendName, FROM_INPUT, HardwareDevice, OpenRequest, guard};
use etalon_backend::{Backend, Unavailable};
use etalon_browser::PageSource;
use etalon_cpu::CpuBackend;
use etalon_keeper::Served;
use etalon_process::Parent;
use etalon_runner::Setup;
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, ErrorKind, Write};
use std::process::Command;
use std::thread;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The request to open an adapter, as JSON
    #[arg(long)]
    pub(crate) open: Option<String>,
    /// List the devices of this backend as JSON
    #[arg(long)]
    pub(crate) enumerate: Option<String>,
    /// Keep the program that standard input names
    #[arg(long)]
    pub(crate) keep: bool,
    /// Guard the program that these words start
    #[arg(long, num_args = 1.., allow_hyphen_values = true, value_name = "WORD")]
    pub(crate) guard: Vec<OsString>,
    /// The guarded program does not read standard input
    #[arg(long, requires = "guard")]
    pub(crate) no_input: bool,
}

/// Serves one adapter, or prints the devices of a backend.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if arguments.keep {
        // Windows ends a program by its job object.
        let guard = if cfg!(unix) {
            Some(guard(false)?)
        } else {
            None
        };
        etalon_keeper::keep(BufReader::new(io::stdin()), guard)?;
        return Ok(0);
    }
    if !arguments.guard.is_empty() {
        return guarded(&arguments.guard, !arguments.no_input);
    }
    let parent = Parent::now();
    let text = match arguments.open.as_deref() {
        Some(FROM_INPUT) => Some(set_up()?),
        other => other.map(str::to_owned),
    };
    // The driver's own output goes to standard error.
    let mut output = etalon_process::private_output()?;
    if let Some(name) = &arguments.enumerate {
        let name: BackendName = parse(&format!("\"{name}\""))?;
        end_with_input()?;
        let found = enumerate(name).unwrap_or_default();
        let text = serde_json::to_string(&found).map_err(Failure::usage)?;
        output.write_all(text.as_bytes())?;
        return Ok(0);
    }
    let Some(text) = text else {
        return Err(Failure::usage("a worker needs --open or --enumerate"));
    };
    let request: OpenRequest = parse(&text)?;
    let input = BufReader::new(io::stdin());
    let pipe = output.try_clone()?;
    let mut output = BufWriter::new(output);
    // The server ends with this process.
    let mut server = None;
    let open = || {
        server = started_server(&request)?;
        let opened = open(&request, pipe);
        server.iter_mut().for_each(Served::connected);
        opened
    };
    let served = etalon_runner::serve(open, input, &mut output);
    drop(server);
    if parent.has_ended() {
        // Nothing else ends what the driver has started.
        etalon_process::end_group()
    }
    match served {
        // The parent wants no more.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(0),
        served => Ok(served.map(|()| 0)?),
    }
}

/// Guards a program, and ends as it ends.
fn guarded(words: &[OsString], input: bool) -> Result<u8, Failure> {
    // A request to end is the program's, which has the same group.
    ctrlc::set_handler(|| {}).map_err(Failure::usage)?;
    let name = words.first().map(|word| word.to_string_lossy());
    let name = name
        .as_deref()
        .unwrap_or_default()
        .escape_debug()
        .to_string();
    match etalon_keeper::guard(words, input) {
        Ok(status) => etalon_process::end_like(status),
        Err(error) if input => Err(Failure::usage(format!(
            "the launcher `{name}` cannot be started: {error}"
        ))),
        Err(error) => Err(Failure::usage(format!("{name}: {error}"))),
    }
}

/// Ends this process when standard input ends.
fn end_with_input() -> io::Result<()> {
    thread::Builder::new().spawn(|| {
        // Nothing is sent; only the end matters.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        etalon_process::end_group()
    })?;
    Ok(())
}

/// Returns the request that the parent sends through a launcher. If the launcher dropped environment
/// variables, replaces this process by one that has them.
fn set_up() -> Result<String, Failure> {
    let setup = Setup::receive(io::stdin().lock())
        .map_err(|e| Failure::usage(format!("--open - takes a request from etalon: {e}")))?;
    let missing = setup.missing();
    if missing.is_empty() {
        return Ok(setup.open);
    }
    let program = std::env::current_exe()?;
    let mut command = Command::new(&program);
    command.args(["worker", "--open", &setup.open]);
    for (name, value) in missing {
        match value {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    let error = etalon_process::replace(&mut command);
    Err(Failure::usage(format!(
        "{} cannot be started with the environment that the adapter needs: {error}",
        program.display()
    )))
}

fn parse<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, Failure> {
    serde_json::from_str(text).map_err(|e| Failure::usage(format!("--open or --enumerate: {e}")))
}

fn open(request: &OpenRequest, pipe: File) -> Result<Box<dyn Backend>, Unavailable> {
    match request.backend {
        BackendName::Cpu => Ok(rasterizer(request, pipe)),
        #[cfg(feature = "vulkan")]
        BackendName::Vulkan => vulkan(request),
        #[cfg(feature = "gl")]
        BackendName::Gl => gl(request, etalon_gl::Profile::Core),
        #[cfg(feature = "gl")]
        BackendName::GlEs => gl(request, etalon_gl::Profile::Es),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuVulkan => wgpu(request, etalon_wgpu::Via::Vulkan),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuGl => wgpu(request, etalon_wgpu::Via::Gl),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuDx12 => wgpu(request, etalon_wgpu::Via::Dx12),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuMetal => wgpu(request, etalon_wgpu::Via::Metal),
        BackendName::Webgpu => browser(request),
        BackendName::External => external(request),
        #[cfg(not(feature = "full"))]
        backend => Err(without(backend)),
    }
}

/// Returns the error for a backend that this build lacks.
#[cfg(not(feature = "full"))]
fn without(backend: BackendName) -> Unavailable {
    let feature = match backend {
        BackendName::Vulkan => "vulkan",
        BackendName::Gl | BackendName::GlEs => "gl",
        _ => "wgpu",
    };
    Unavailable::new(
        format!("this etalon was built without the feature `{feature}`"),
        format!("cargo install etalon --features {feature}"),
    )
}

#[cfg(feature = "vulkan")]
fn vulkan(request: &OpenRequest) -> Result<Box<dyn Backend>, Unavailable> {
    let options = etalon_vulkan::VulkanOptions {
        device: request.device.unwrap_or(0),
        validate: request.validate,
        fault: request.fault,
        record: request.record,
    };
    etalon_vulkan::open(&request.name, &options).map(|b| Box::new(b) as Box<dyn Backend>)
}

#[cfg(feature = "gl")]
fn gl(request: &OpenRequest, profile: etalon_gl::Profile) -> Result<Box<dyn Backend>, Unavailable> {
    let options = etalon_gl::GlOptions {
        profile,
        platform: match request.device {
            None => etalon_gl::Platform::Surfaceless,
            Some(index) => etalon_gl::Platform::Device(index),
        },
        library: request.egl.clone(),
        debug: request.validate,
        fault: request.fault,
        record: request.record,
    };
    etalon_gl::open(&request.name, &options).map(|b| Box::new(b) as Box<dyn Backend>)
}

#[cfg(feature = "wgpu")]
fn wgpu(request: &OpenRequest, via: etalon_wgpu::Via) -> Result<Box<dyn Backend>, Unavailable> {
    let options = etalon_wgpu::WgpuOptions {
        via,
        device: request.device.unwrap_or(0),
        validate: request.validate,
        fault: request.fault,
        record: request.record,
    };
    etalon_wgpu::open(&request.name, &options).map(|b| Box::new(b) as Box<dyn Backend>)
}

/// Opens the rasterizer. A planted fault can write to the pipe to the parent.
#[cfg(feature = "faults")]
fn rasterizer(request: &OpenRequest, pipe: File) -> Box<dyn Backend> {
    match request.fault {
        None => Box::new(CpuBackend::new(&request.name)),
        Some(fault) => Box::new(crate::faulty::Faulty::new(&request.name, fault, pipe)),
    }
}

#[cfg(not(feature = "faults"))]
fn rasterizer(request: &OpenRequest, _pipe: File) -> Box<dyn Backend> {
    Box::new(CpuBackend::new(&request.name))
}

/// Returns the command of a keeper.
fn keeper() -> Result<Command, Unavailable> {
    let program = std::env::current_exe().map_err(|error| {
        Unavailable::new(
            format!("cannot find the program file of etalon: {error}"),
            "start it by its path",
        )
    })?;
    let mut keeper = Command::new(program);
    keeper.args(["worker", "--keep"]);
    Ok(keeper)
}

/// Starts the server of an adapter's driver, if it has one.
fn started_server(request: &OpenRequest) -> Result<Option<Served>, Unavailable> {
    let Some(server) = &request.server else {
        return Ok(None);
    };
    let served = server.start(keeper()?);
    let served = served.map_err(|error| Unavailable::new(error.to_string(), error.remedy()))?;
    Ok(Some(served))
}

/// Starts the browser of an adapter, or waits for one.
fn browser(request: &OpenRequest) -> Result<Box<dyn Backend>, Unavailable> {
    let source = match (&request.browser, &request.listen) {
        (Some(browser), _) => PageSource::Started(browser.clone(), keeper()?),
        (None, Some(listen)) => PageSource::Listening(listen.address, listen.token.clone()),
        (None, None) => {
            return Err(Unavailable::new(
                "the adapter has neither `browser` nor `listen`",
                "correct its entry",
            ));
        }
    };
    let options = etalon_browser::BrowserOptions {
        source,
        validate: request.validate,
        fault: request.fault,
        record: request.record,
    };
    etalon_browser::open(&request.name, options).map(|b| Box::new(b) as Box<dyn Backend>)
}

/// Starts the program of an adapter.
fn external(request: &OpenRequest) -> Result<Box<dyn Backend>, Unavailable> {
    let missing = || Unavailable::new("the adapter has no `command`", "correct its entry");
    let program = request.program.as_ref().ok_or_else(missing)?;
    let (name, words) = program.command.split_first().ok_or_else(missing)?;
    let mut command = Command::new(name);
    command.args(words);
    if let Some(folder) = &program.folder {
        command.current_dir(folder);
    }
    etalon_external::open(&request.name, command).map(|b| Box::new(b) as Box<dyn Backend>)
}

/// Returns the hardware devices; software drivers are described in the data file.
fn enumerate(backend: BackendName) -> Result<Vec<HardwareDevice>, Unavailable> {
    match backend {
        BackendName::Cpu | BackendName::Webgpu | BackendName::External => Ok(Vec::new()),
        #[cfg(feature = "vulkan")]
        BackendName::Vulkan => etalon_vulkan::enumerate().map(hardware),
        #[cfg(feature = "gl")]
        BackendName::Gl => gl_devices("gl"),
        #[cfg(feature = "gl")]
        BackendName::GlEs => gl_devices("gl:es"),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuVulkan => etalon_wgpu::enumerate(etalon_wgpu::Via::Vulkan).map(hardware),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuGl => etalon_wgpu::enumerate(etalon_wgpu::Via::Gl).map(hardware),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuDx12 => etalon_wgpu::enumerate(etalon_wgpu::Via::Dx12).map(hardware),
        #[cfg(feature = "wgpu")]
        BackendName::WgpuMetal => etalon_wgpu::enumerate(etalon_wgpu::Via::Metal).map(hardware),
        #[cfg(not(feature = "full"))]
        backend => Err(without(backend)),
    }
}

/// Returns the devices that are hardware, with their place among all.
#[cfg(any(feature = "vulkan", feature = "wgpu"))]
fn hardware(devices: Vec<etalon_frame::AdapterInfo>) -> Vec<HardwareDevice> {
    let numbered = devices.into_iter().enumerate();
    numbered
        .filter(|(_, info)| !info.software)
        .map(|(device, info)| HardwareDevice {
            name: info.name,
            device,
        })
        .collect()
}

#[cfg(feature = "gl")]
fn gl_devices(prefix: &str) -> Result<Vec<HardwareDevice>, Unavailable> {
    let devices = etalon_gl::enumerate()?;
    let hardware = devices.into_iter().filter(|d| !d.software);
    Ok(hardware
        .map(|d| HardwareDevice {
            name: format!("{prefix}:{}", d.driver.as_deref().unwrap_or("gpu")),
            device: d.index,
        })
        .collect())
}
