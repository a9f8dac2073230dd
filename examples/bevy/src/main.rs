// Not run in Bevy: written for Bevy 0.15, not compiled, since no crates were at hand. layout.rs,
// sea_waves.rs and the shaders are compiled and run. README.bevy.md has ten steps.
//! The sea of the run-time package in this folder, and a buoy on it. Bevy's x is east, y up, z south.

mod kernels;
mod layout;
#[path = "../sea_waves.rs"]
mod sea_waves;

use bevy::{
    pbr::{NotShadowCaster, NotShadowReceiver},
    prelude::*,
    render::{
        mesh::{Indices, PrimitiveTopology},
        render_asset::RenderAssetUsages,
        render_resource::{AsBindGroup, BufferUsages, ShaderRef, ShaderType},
        storage::ShaderStorageBuffer,
        view::NoFrustumCulling,
    },
};
use std::f32::consts::TAU;
use std::sync::Arc;

use kernels::{SeaFrame, SeaKernelsPlugin};
use layout::Layout;
use sea_waves::SeaWaves;

const FOLDER: &str = "."; // of sea.json and the shaders
const STRONGEST: usize = 400; // waves that heights on the CPU sum
const REACH: f32 = 4000.0; // to the edge of the mesh [m]

/// The waves on the CPU: all moments are those of the same clock.
#[derive(Resource)]
struct Sea(SeaWaves);

#[derive(Component)]
struct Buoy;

#[derive(Component)]
struct Surface;

/// What sea_water.wgsl needs to find its place in each tile.
#[derive(Clone, ShaderType, Default)]
struct SeaPlaces {
    eye: Vec4,            // x, still water level, z, 0
    count: UVec4,         // tiles, 0, 0, 0
    sun: Vec4,            // direction to it, brightness
    places: [Vec4; 16],   // sides [m]; place of the eye in the tile, 0 to 1
    samples: [UVec4; 16], // nx, ny, first texel in maps, 0
}

#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct SeaMaterial {
    #[storage(0, read_only, visibility(vertex, fragment))]
    maps: Handle<ShaderStorageBuffer>,
    #[uniform(1)]
    places: SeaPlaces,
}

impl Material for SeaMaterial {
    fn vertex_shader() -> ShaderRef {
        "sea_water.wgsl".into()
    }

    fn fragment_shader() -> ShaderRef {
        "sea_water.wgsl".into()
    }
}

fn main() {
    App::new()
        .add_plugins(DefaultPlugins.set(AssetPlugin { file_path: FOLDER.into(), ..default() }))
        .add_plugins((MaterialPlugin::<SeaMaterial>::default(), SeaKernelsPlugin))
        .add_systems(Startup, start)
        .add_systems(Update, (fly, advance, float).chain())
        .run();
}

fn start(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<SeaMaterial>>,
    mut plain: ResMut<Assets<StandardMaterial>>,
    mut buffers: ResMut<Assets<ShaderStorageBuffer>>,
) {
    // A damaged package ends the program with the file and the rule.
    let all = SeaWaves::open(FOLDER, usize::MAX).unwrap_or_else(|rule| panic!("{rule}"));
    let layout = Arc::new(Layout::new(&all).unwrap_or_else(|rule| panic!("{rule}")));
    let quick = SeaWaves::open(FOLDER, STRONGEST).unwrap_or_else(|rule| panic!("{rule}"));
    info!("the strongest waves leave out {} m (rms)", quick.neglected_rms);
    let bytes = vec![0u8; 16 * layout.map_texels as usize];
    let mut maps = ShaderStorageBuffer::new(&bytes, RenderAssetUsages::RENDER_WORLD);
    maps.buffer_description.usage |= BufferUsages::STORAGE;
    let maps = buffers.add(maps);
    let block = layout.block(0, all.choppiness as f32);
    let mut places = SeaPlaces {
        count: UVec4::new(layout.tiles.len() as u32, 0, 0, 0),
        sun: Vec4::new(0.45, 0.35, -0.6, 20.0),
        ..default()
    };
    for (i, tile) in layout.tiles.iter().enumerate() {
        places.samples[i] = UVec4::new(tile.nx, tile.ny, tile.first_map, 0);
    }
    commands.spawn((
        Mesh3d(meshes.add(rings(0.4, REACH, 360))),
        MeshMaterial3d(materials.add(SeaMaterial { maps: maps.clone(), places })),
        (NoFrustumCulling, NotShadowCaster, NotShadowReceiver, Surface),
    ));
    commands.spawn((
        Mesh3d(meshes.add(Sphere::new(0.6))),
        MeshMaterial3d(plain.add(Color::srgb(0.9, 0.3, 0.1))),
        Buoy,
    ));
    commands.spawn((
        DirectionalLight::default(),
        Transform::default().looking_to(Vec3::new(-0.45, -0.35, 0.6), Vec3::Y),
    ));
    commands.spawn((
        Camera3d::default(),
        Transform::from_xyz(0.0, 6.0, 16.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.insert_resource(SeaFrame { layout, block, maps });
    commands.insert_resource(Sea(quick));
}

/// Give this frame's moment to the kernels, and the camera's place in each tile to the material.
fn advance(
    time: Res<Time>,
    sea: Res<Sea>,
    mut frame: ResMut<SeaFrame>,
    mut materials: ResMut<Assets<SeaMaterial>>,
    surface: Query<&MeshMaterial3d<SeaMaterial>, With<Surface>>,
    camera: Query<&Transform, With<Camera3d>>,
) {
    let loops = time.elapsed_secs_f64() / sea.0.period;
    let ticks = frame.layout.ticks;
    // The loop is a whole number of ticks: a phase is exact for ever.
    let tick = (loops.fract() * f64::from(ticks)) as u32 & (ticks - 1);
    let block = frame.layout.block(tick, sea.0.choppiness as f32);
    frame.block = block;
    let (Ok(handle), Ok(camera)) = (surface.get_single(), camera.get_single()) else { return };
    let Some(material) = materials.get_mut(&handle.0) else { return };
    let eye = camera.translation;
    material.places.eye = Vec4::new(eye.x, 0.0, eye.z, 0.0);
    for (i, tile) in frame.layout.tiles.iter().enumerate() {
        let [lx, ly] = tile.size;
        // North is -z; reduced in double precision.
        let (u, v) = (f64::from(eye.x) / lx, -f64::from(eye.z) / ly);
        let place = [u - u.floor(), v - v.floor()];
        material.places.places[i] =
            Vec4::new(lx as f32, ly as f32, place[0] as f32, place[1] as f32);
    }
}

/// Hold the buoy where the water that rests at the origin is.
fn float(time: Res<Time>, sea: Res<Sea>, mut buoys: Query<&mut Transform, With<Buoy>>) {
    let water = sea.0.rest(0.0, 0.0, time.elapsed_secs_f64());
    let [x, y, z] = water.normal.map(|part| part as f32);
    for mut buoy in &mut buoys {
        buoy.translation = Vec3::new(water.x as f32, water.height as f32, -water.y as f32);
        buoy.rotation = Quat::from_rotation_arc(Vec3::Y, Vec3::new(x, z, -y));
    }
}

fn fly(
    time: Res<Time>,
    keys: Res<ButtonInput<KeyCode>>,
    mut cameras: Query<&mut Transform, With<Camera3d>>,
) {
    for mut camera in &mut cameras {
        let (ahead, right) = (*camera.forward(), *camera.right());
        for (key, way) in [
            (KeyCode::KeyW, ahead),
            (KeyCode::KeyS, -ahead),
            (KeyCode::KeyA, -right),
            (KeyCode::KeyD, right),
            (KeyCode::KeyE, Vec3::Y),
            (KeyCode::KeyQ, -Vec3::Y),
        ] {
            if keys.pressed(key) {
                camera.translation += 15.0 * time.delta_secs() * way;
            }
        }
        camera.translation.y = camera.translation.y.max(1.0);
    }
}

/// A flat disc of rings whose spacing grows with the distance; uv.x is the spacing [m].
fn rings(inner: f32, outer: f32, spokes: u32) -> Mesh {
    let growth = 1.0 + TAU / spokes as f32; // cells are squares
    let count = 2 + ((outer / inner).ln() / growth.ln()).ceil() as u32;
    let (mut places, mut spacing, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..count {
        let radius = inner * growth.powi(ring as i32);
        for spoke in 0..spokes {
            let (sine, cosine) = (TAU * spoke as f32 / spokes as f32).sin_cos();
            places.push([radius * cosine, 0.0, radius * sine]);
            spacing.push([radius * (growth - 1.0), 0.0]);
            let (here, next) = (ring * spokes + spoke, ring * spokes + (spoke + 1) % spokes);
            if ring > 0 {
                let (below, beside) = (here - spokes, next - spokes);
                corners.extend([below, beside, here, here, beside, next]);
            }
        }
    }
    places.push([0.0, 0.0, 0.0]);
    spacing.push([inner, 0.0]);
    for spoke in 0..spokes {
        corners.extend([count * spokes, (spoke + 1) % spokes, spoke]);
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 1.0, 0.0]; places.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, spacing)
        .with_inserted_indices(Indices::U32(corners))
}
