//! Keys of stages, and when the tables of a scene take part.

use schemars::JsonSchema;
use serde::Deserialize;

use super::*;
use crate::scene::value::Located;

/// An analysis that starts where the stage before it ended.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StageTable {
    /// Its name, by which effects, supports and joints refer to it; also that of its folder.
    pub name: Located<String>,
    /// What to compute: exactly one kind.
    pub analysis: Located<AnalysisTable>,
}

/// The stages at whose start something comes and goes.
#[derive(Clone, Copy)]
pub struct During<'f> {
    /// The first when left out.
    pub stage: Option<&'f Located<String>>,
    /// It stays to the end when left out.
    pub until: Option<&'f Located<String>>,
}

/// A table of something that may come and go.
pub trait Staged {
    /// When it takes part.
    fn during(&self) -> During<'_>;
}

impl<T: Staged> Staged for Located<T> {
    fn during(&self) -> During<'_> {
        self.get().during()
    }
}

macro_rules! staged {
    ($($table:ty),* $(,)?) => {$(
        impl Staged for $table {
            fn during(&self) -> During<'_> {
                During { stage: self.stage.as_ref(), until: self.until.as_ref() }
            }
        }
    )*};
}

staged!(
    SupportTable,
    JointTable,
    ForceTable,
    MomentTable,
    DistributedForceTable,
    GravityTable,
    DampingTable,
    SpringTable,
    TorsionSpringTable,
    PointMassTable,
    SectionInertiaTable,
    FoundationTable,
    ActuationTable,
    DragTable,
    BuoyancyTable,
    ElectrostaticTable,
    ForceFieldTable,
    MovingForceTable,
    ContactTable,
);

impl SceneTable {
    /// Keeps those supports, joints and effects for which `keep` holds, and asks it for all of them
    /// in order.
    pub fn retain(&mut self, keep: &mut dyn FnMut(During<'_>) -> bool) {
        self.support.retain(|table| keep(table.during()));
        self.joint.retain(|table| keep(table.during()));
        let EffectTable {
            force,
            moment,
            distributed_force,
            gravity,
            damping,
            spring,
            torsion_spring,
            point_mass,
            rotary_inertia,
            foundation,
            actuation,
            drag,
            buoyancy,
            electrostatic,
            force_field,
            moving_force,
            contact,
        } = &mut self.effect;
        force.retain(|table| keep(table.during()));
        moment.retain(|table| keep(table.during()));
        distributed_force.retain(|table| keep(table.during()));
        *gravity = gravity.take().filter(|table| keep(table.during()));
        damping.retain(|table| keep(table.during()));
        spring.retain(|table| keep(table.during()));
        torsion_spring.retain(|table| keep(table.during()));
        point_mass.retain(|table| keep(table.during()));
        rotary_inertia.retain(|table| keep(table.during()));
        foundation.retain(|table| keep(table.during()));
        actuation.retain(|table| keep(table.during()));
        drag.retain(|table| keep(table.during()));
        buoyancy.retain(|table| keep(table.during()));
        electrostatic.retain(|table| keep(table.during()));
        force_field.retain(|table| keep(table.during()));
        moving_force.retain(|table| keep(table.during()));
        contact.retain(|table| keep(table.during()));
    }
}
