// Not run in Bevy: written for Bevy 0.15 and not compiled, since no crates were at hand.
//! Kernels of the sea in Bevy's render graph: they fill the storage buffer that the material reads.

use bevy::{
    prelude::*,
    render::{
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        graph::CameraDriverLabel,
        render_asset::RenderAssets,
        render_graph::{self, RenderGraph, RenderLabel},
        render_resource::*,
        renderer::{RenderContext, RenderDevice, RenderQueue},
        storage::{GpuShaderStorageBuffer, ShaderStorageBuffer},
        Render, RenderApp, RenderSet,
    },
};
use std::sync::Arc;

use crate::layout::{bytes_of, Layout};

const ENTRY_POINTS: [&str; 4] = ["rows", "columns", "mips", "mips_far"];

/// What the render world needs of the sea: the arrays, and the block of this frame.
#[derive(Resource, Clone, ExtractResource)]
pub struct SeaFrame {
    pub layout: Arc<Layout>,
    pub block: Vec<u8>,
    pub maps: Handle<ShaderStorageBuffer>,
}

pub struct SeaKernelsPlugin;

#[derive(Debug, Hash, PartialEq, Eq, Clone, RenderLabel)]
struct SeaLabel;

impl Plugin for SeaKernelsPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractResourcePlugin::<SeaFrame>::default());
        let render_app = app.sub_app_mut(RenderApp);
        render_app.add_systems(Render, prepare.in_set(RenderSet::PrepareBindGroups));
        let mut graph = render_app.world_mut().resource_mut::<RenderGraph>();
        graph.add_node(SeaLabel, SeaNode);
        graph.add_node_edge(SeaLabel, CameraDriverLabel);
    }

    fn finish(&self, app: &mut App) {
        app.sub_app_mut(RenderApp).init_resource::<SeaPipelines>();
    }
}

#[derive(Resource)]
struct SeaPipelines {
    layout: BindGroupLayout,
    pipelines: Vec<CachedComputePipelineId>, // in the order of ENTRY_POINTS
}

impl FromWorld for SeaPipelines {
    fn from_world(world: &mut World) -> Self {
        let storage = |read_only| BufferBindingType::Storage { read_only };
        let kinds = [
            BufferBindingType::Uniform,
            storage(true),  // h0
            storage(true),  // wave
            storage(true),  // twiddle
            storage(false), // work
            storage(false), // maps
        ];
        let entries: Vec<BindGroupLayoutEntry> = (0u32..)
            .zip(kinds)
            .map(|(binding, ty)| BindGroupLayoutEntry {
                binding,
                visibility: ShaderStages::COMPUTE,
                ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
                count: None,
            })
            .collect();
        let layout =
            world.resource::<RenderDevice>().create_bind_group_layout("fftocean", &entries);
        let shader = world.load_asset("fftocean.wgsl");
        let cache = world.resource::<PipelineCache>();
        let pipelines = ENTRY_POINTS
            .iter()
            .map(|entry| {
                cache.queue_compute_pipeline(ComputePipelineDescriptor {
                    label: Some((*entry).into()),
                    layout: vec![layout.clone()],
                    push_constant_ranges: Vec::new(),
                    shader: shader.clone(),
                    shader_defs: vec![],
                    entry_point: (*entry).into(),
                    zero_initialize_workgroup_memory: false,
                })
            })
            .collect();
        Self { layout, pipelines }
    }
}

#[derive(Resource)]
struct SeaBuffers {
    sea: Buffer,
    group: BindGroup,
}

/// Make the buffers once; write the block of every frame.
fn prepare(
    mut commands: Commands,
    frame: Option<Res<SeaFrame>>,
    made: Option<Res<SeaBuffers>>,
    pipelines: Res<SeaPipelines>,
    storage: Res<RenderAssets<GpuShaderStorageBuffer>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    let Some(frame) = frame else { return };
    if let Some(made) = made {
        queue.write_buffer(&made.sea, 0, &frame.block);
        return;
    }
    let Some(maps) = storage.get(&frame.maps) else { return };
    let filled = |label: &'static str, contents: &[u8], usage: BufferUsages| {
        device.create_buffer_with_data(&BufferInitDescriptor {
            label: Some(label),
            contents,
            usage,
        })
    };
    let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    let sea = filled("sea", &frame.block, uniform);
    let h0 = filled("h0", &bytes_of(&frame.layout.h0), BufferUsages::STORAGE);
    let wave = filled("wave", &bytes_of(&frame.layout.wave), BufferUsages::STORAGE);
    let twiddle = filled("twiddle", &bytes_of(&frame.layout.twiddle), BufferUsages::STORAGE);
    let work = device.create_buffer(&BufferDescriptor {
        label: Some("work"),
        size: 32 * u64::from(frame.layout.texels),
        usage: BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let buffers = [&sea, &h0, &wave, &twiddle, &work, &maps.buffer];
    let entries: Vec<BindGroupEntry> = (0u32..)
        .zip(buffers)
        .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    let group = device.create_bind_group("fftocean", &pipelines.layout, &entries);
    commands.insert_resource(SeaBuffers { sea, group });
}

struct SeaNode;

impl render_graph::Node for SeaNode {
    fn run(
        &self,
        _graph: &mut render_graph::RenderGraphContext,
        context: &mut RenderContext,
        world: &World,
    ) -> Result<(), render_graph::NodeRunError> {
        let (Some(frame), Some(buffers)) =
            (world.get_resource::<SeaFrame>(), world.get_resource::<SeaBuffers>())
        else {
            return Ok(());
        };
        let cache = world.resource::<PipelineCache>();
        let ids = &world.resource::<SeaPipelines>().pipelines;
        let ready: Option<Vec<&ComputePipeline>> =
            ids.iter().map(|id| cache.get_compute_pipeline(*id)).collect();
        let Some(ready) = ready else { return Ok(()) }; // still compiling
        let layout = &frame.layout;
        let tiles = layout.tiles.len() as u32;
        let blocks = layout.longest.div_ceil(32);
        let groups = [
            (layout.groups, tiles, 1),
            (layout.groups, tiles, 1),
            (blocks, blocks, 3 * tiles),
            (1, 1, 3 * tiles),
        ];
        for (pipeline, (x, y, z)) in ready.into_iter().zip(groups) {
            let mut pass =
                context.command_encoder().begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_bind_group(0, &buffers.group, &[]);
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(x, y, z);
        }
        Ok(())
    }
}
