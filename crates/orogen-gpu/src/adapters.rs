//! The graphics cards of this machine, and whether they can be used.

use std::fmt;

/// A graphics card, or a driver that computes on the processor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Adapter {
    /// Its number among the adapters of this machine, from 0.
    pub index: usize,
    /// The name from its driver.
    pub name: String,
    /// Its kind.
    pub kind: Kind,
    /// The interface by which it is used: `vulkan`, `metal` or `dx12`.
    pub interface: &'static str,
    /// The driver and its version, if known.
    pub driver: String,
    /// The limits that are relevant here.
    pub limits: Limits,
    /// The reason why it cannot be used; `None` if it can.
    pub refused: Option<String>,
}

/// The kind of an adapter, in order of preference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A card with its own memory.
    Discrete,
    /// A graphics unit that shares the processor's memory.
    Integrated,
    /// A virtual card, on the host of a virtual machine.
    Virtual,
    /// An unknown kind.
    Other,
    /// A driver that computes on the processor, such as Mesa's lavapipe: slower than the engine itself, and used only
    /// on request.
    Software,
}

impl Kind {
    /// The name in listings.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Kind::Discrete => "discrete",
            Kind::Integrated => "integrated",
            Kind::Virtual => "virtual",
            Kind::Other => "other",
            Kind::Software => "software",
        }
    }
}

/// The limits of an adapter that determine how work is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Maximum size of a buffer that a shader uses, in bytes. Larger windows are computed in tiles.
    pub buffer: u64,
    /// Maximum number of workgroups along an axis.
    pub workgroups: u32,
    /// Maximum number of invocations in a workgroup.
    pub invocations: u32,
}

/// The minimum limits for the shaders, which every implementation of WebGPU has.
pub(crate) const LEAST: Limits = Limits { buffer: 128 << 20, workgroups: 65_535, invocations: 256 };

/// The choice of an adapter.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Choice {
    /// The first usable card that is not software.
    #[default]
    Card,
    /// The first usable adapter, including software.
    Any,
    /// The adapter with this index, or the first one whose name contains this text, ignoring case.
    Named(String),
}

impl Choice {
    /// Whether the choice allows an adapter.
    pub(crate) fn allows(&self, adapter: &Adapter) -> bool {
        match self {
            Choice::Card => adapter.kind != Kind::Software,
            Choice::Any => true,
            Choice::Named(name) => {
                name.parse() == Ok(adapter.index) || adapter.name.to_lowercase().contains(&name.to_lowercase())
            }
        }
    }
}

impl fmt::Display for Adapter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}, {})", self.name, self.kind.name(), self.interface)
    }
}

/// The adapters of this machine, in the order in which they are tried: discrete cards first, software last.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    found().into_iter().map(|(adapter, _)| adapter).collect()
}

/// The adapters with their handles.
pub(crate) fn found() -> Vec<(Adapter, wgpu::Adapter)> {
    let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle();
    wanted.backends = backends;
    wanted.flags = wgpu::InstanceFlags::empty();
    if wgpu::Instance::enabled_backend_features().is_empty() {
        return Vec::new();
    }
    let instance = wgpu::Instance::new(wanted);
    let mut handles = pollster::block_on(instance.enumerate_adapters(backends));
    handles.sort_by_key(|handle| kind(handle.get_info().device_type));
    handles.into_iter().enumerate().map(|(index, handle)| (described(index, &handle), handle)).collect()
}

fn kind(device: wgpu::DeviceType) -> Kind {
    match device {
        wgpu::DeviceType::DiscreteGpu => Kind::Discrete,
        wgpu::DeviceType::IntegratedGpu => Kind::Integrated,
        wgpu::DeviceType::VirtualGpu => Kind::Virtual,
        wgpu::DeviceType::Cpu => Kind::Software,
        wgpu::DeviceType::Other => Kind::Other,
    }
}

fn described(index: usize, handle: &wgpu::Adapter) -> Adapter {
    let (info, limits) = (handle.get_info(), handle.limits());
    let limits = Limits {
        buffer: limits.max_storage_buffer_binding_size.min(limits.max_buffer_size),
        workgroups: limits.max_compute_workgroups_per_dimension,
        invocations: limits.max_compute_invocations_per_workgroup,
    };
    let can_compute = handle.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS);
    let refused = match () {
        () if !can_compute => Some("it has no compute shaders".to_string()),
        () if limits.buffer < LEAST.buffer => {
            Some(format!("its buffers have at most {} MiB; {} are needed", limits.buffer >> 20, LEAST.buffer >> 20))
        }
        () if limits.workgroups < LEAST.workgroups || limits.invocations < LEAST.invocations => Some(format!(
            "its workgroups have at most {} invocations; {} are needed",
            limits.invocations, LEAST.invocations
        )),
        () => None,
    };
    Adapter {
        index,
        name: info.name,
        kind: kind(info.device_type),
        interface: match info.backend {
            wgpu::Backend::Vulkan => "vulkan",
            wgpu::Backend::Metal => "metal",
            wgpu::Backend::Dx12 => "dx12",
            _ => "other",
        },
        driver: [info.driver, info.driver_info].join(" ").trim().to_string(),
        limits,
        refused,
    }
}
