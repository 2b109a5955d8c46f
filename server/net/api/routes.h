#pragma once

namespace strata::net {

class Router;
class SignOnDesk;
struct RouteContext;

// Each function adds the routes of one type of resource.
void add_system_routes(Router& router, const RouteContext& context);
void add_auth_routes(Router& router, const RouteContext& context);
void add_sign_on_routes(Router& router, const RouteContext& context, SignOnDesk& desk);
void add_people_routes(Router& router, const RouteContext& context);
void add_personal_view_routes(Router& router, const RouteContext& context);
void add_project_routes(Router& router, const RouteContext& context);
void add_node_routes(Router& router, const RouteContext& context);
void add_member_routes(Router& router, const RouteContext& context);
void add_group_routes(Router& router, const RouteContext& context);
void add_activity_routes(Router& router, const RouteContext& context);
void add_audit_routes(Router& router, const RouteContext& context);
void add_trash_routes(Router& router, const RouteContext& context);
void add_model_routes(Router& router, const RouteContext& context);
void add_metadata_routes(Router& router, const RouteContext& context);
void add_object_routes(Router& router, const RouteContext& context);
void add_bill_routes(Router& router, const RouteContext& context);
void add_import_routes(Router& router, const RouteContext& context);
void add_job_routes(Router& router, const RouteContext& context);
void add_layer_routes(Router& router, const RouteContext& context);
void add_surface_image_routes(Router& router, const RouteContext& context);
void add_comment_routes(Router& router, const RouteContext& context);
void add_view_routes(Router& router, const RouteContext& context);
void add_tour_routes(Router& router, const RouteContext& context);
void add_tour_file_routes(Router& router, const RouteContext& context);
void add_kiosk_routes(Router& router, const RouteContext& context);
void add_tool_routes(Router& router, const RouteContext& context);
void add_table_routes(Router& router, const RouteContext& context);
void add_term_routes(Router& router, const RouteContext& context);
void add_template_routes(Router& router, const RouteContext& context);
void add_record_routes(Router& router, const RouteContext& context);
void add_attachment_routes(Router& router, const RouteContext& context);
void add_attachment_match_routes(Router& router, const RouteContext& context);
void add_edit_routes(Router& router, const RouteContext& context);
void add_query_routes(Router& router, const RouteContext& context);
void add_statistics_routes(Router& router, const RouteContext& context);
void add_quantity_routes(Router& router, const RouteContext& context);
void add_extent_routes(Router& router, const RouteContext& context);
void add_feature_routes(Router& router, const RouteContext& context);
void add_vertex_routes(Router& router, const RouteContext& context);
void add_selection_routes(Router& router, const RouteContext& context);
void add_snapshot_routes(Router& router, const RouteContext& context);
void add_timeline_routes(Router& router, const RouteContext& context);
void add_frame_routes(Router& router, const RouteContext& context);
void add_export_routes(Router& router, const RouteContext& context);
void add_figure_routes(Router& router, const RouteContext& context);
void add_layer_preview_routes(Router& router, const RouteContext& context);
void add_rollout_routes(Router& router, const RouteContext& context);
void add_texel_routes(Router& router, const RouteContext& context);
void add_change_routes(Router& router, const RouteContext& context);
void add_cleanup_routes(Router& router, const RouteContext& context);
void add_analysis_routes(Router& router, const RouteContext& context);
void add_shape_routes(Router& router, const RouteContext& context);
void add_map_routes(Router& router, const RouteContext& context);
void add_photograph_routes(Router& router, const RouteContext& context);
void add_orthophoto_routes(Router& router, const RouteContext& context);
void add_linked_routes(Router& router, const RouteContext& context);
void add_annotation_routes(Router& router, const RouteContext& context);
void add_ogc_routes(Router& router, const RouteContext& context);
void add_ogc_item_routes(Router& router, const RouteContext& context);
void add_ogc_coverage_routes(Router& router, const RouteContext& context);
void add_ogc_query_routes(Router& router, const RouteContext& context);

}  // namespace strata::net
